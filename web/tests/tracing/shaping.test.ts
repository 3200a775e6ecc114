import { describe, expect, it } from 'vitest';
import { Cells } from '../../src/document/cells';
import { chooseCandidate, movePoint } from '../../src/document/commands';
import * as history from '../../src/document/history';
import { type Answer, oneClickOutline } from '../../src/tracing/one_click_result';
import { copyOutline, tracedNeighbour } from '../../src/document/outlines';
import { carriedSides } from '../../src/document/sides';
import { ahead, markedStretch, perimeter, pointsOf } from '../../src/document/stretch';
import { cellOf, EMPTY_CELL, EMPTY_DOC, verdictOf, type Doc, type Outline } from '../../src/document/types';
import { piecesOf } from '../../src/tracing/snapping';
import { sidesFrom } from '../../src/tracing/pixels';
import type { Match, MatchedCandidate } from '../../src/workers/protocol/match';
import { canvasPoint, framePoint } from '../../src/geometry/points';
import { clockwise } from '../../src/geometry/rings';
import { boundsOf, middleOf, moved, scaled, transformed, rotated } from '../../src/geometry/similarity';
import { Controller } from '../../src/interaction/controller';
import type { Effect, Input, Situation } from '../../src/interaction/machine';
import { Touches } from '../../src/interaction/touch';
import type { ToolName } from '../../src/terms/tool';

const PLACE = { frameId: 'f', component: 'femur' } as const;

function outlineOf(points: readonly (readonly [number, number])[], unknownSides: readonly number[] = []): Outline {
  return { points: points.map(([column, row]) => framePoint(column, row)), closed: true, unknownSides };
}

const SQUARE = outlineOf([[100, 100], [200, 100], [200, 200], [100, 200]]);

function docWith(outline: Outline): Doc {
  return { ...EMPTY_DOC, cells: Cells.from([['f/femur', { ...EMPTY_CELL, outline }]]) };
}

/** A tool on an outline, a frame shown at its own size. */
class Bench {
  readonly controller = new Controller();
  history: history.History;

  constructor(
    readonly tool: ToolName,
    outline: Outline,
  ) {
    this.history = history.startHistory(docWith(outline));
  }

  get outline(): Outline {
    return cellOf(this.history.present, 'f', 'femur').outline!;
  }

  get points(): (readonly [number, number])[] {
    return this.outline.points.map(({ column, row }) => [Math.round(column * 1e6) / 1e6, Math.round(row * 1e6) / 1e6] as const);
  }

  send(type: Input['type'], [x, y]: readonly [number, number], alt = false): void {
    const situation: Situation = {
      viewport: { scale: 1, left: 0, top: 0 },
      frame: { width: 500, height: 500 },
      place: PLACE,
      outline: this.outline,
      window: { centre: 100, width: 200 },
      erase: false,
    };
    const input = { type, at: canvasPoint(x, y), button: 'primary', alt } as const;
    for (const effect of this.controller.handle(this.tool, input, situation, false)) this.#apply(effect);
  }

  drag(way: readonly (readonly [number, number])[], alt = false): void {
    this.send('down', way[0]!, alt);
    for (const place of way.slice(1)) this.send('move', place, alt);
    this.send('up', way.at(-1)!, alt);
  }

  undo(): void {
    this.history = history.undo(this.history);
  }

  #apply(effect: Effect): void {
    if (effect.type === 'perform') this.history = history.perform(this.history, effect.command);
    if (effect.type === 'preview') this.history = history.preview(this.history, effect.command);
    if (effect.type === 'cancel-preview') this.history = history.cancelPreview(this.history);
    if (effect.type === 'commit') {
      this.history = history.commitPreview(history.preview(this.history, effect.command), effect.command);
    }
  }
}

describe('similarities', () => {
  it('turn clockwise on the screen, scale and move', () => {
    const [point] = transformed(rotated(framePoint(10, 10), Math.PI / 2), [framePoint(20, 10)]);
    expect(point!.column).toBeCloseTo(10, 9);
    expect(point!.row).toBeCloseTo(20, 9);
    expect(transformed(scaled(framePoint(10, 10), 2), [framePoint(20, 15)])).toEqual([{ column: 30, row: 20 }]);
    expect(transformed(moved(3, -2), [framePoint(1, 1)])).toEqual([{ column: 4, row: -1 }]);
  });

  it('know the middle', () => {
    expect(middleOf(boundsOf(SQUARE.points)!)).toEqual({ column: 150, row: 150 });
    expect(boundsOf([])).toBeNull();
  });
});

describe('the tool that moves a whole outline', () => {
  it('moves it by a drag inside, as one unit of undo', () => {
    const bench = new Bench('transform', SQUARE);
    bench.drag([[150, 150], [160, 150], [170, 140]]);
    expect(bench.points).toEqual([[120, 90], [220, 90], [220, 190], [120, 190]]);
    expect(bench.history.past).toHaveLength(1);
    bench.undo();
    expect(bench.outline).toBe(SQUARE);
  });

  it('scales from the opposite corner, with Alt about the middle', () => {
    const bench = new Bench('transform', SQUARE);
    bench.drag([[200, 200], [250, 250], [300, 300]]);
    expect(bench.points).toEqual([[100, 100], [300, 100], [300, 300], [100, 300]]);
    bench.undo();
    bench.drag([[200, 200], [220, 220], [250, 250]], true);
    expect(bench.points).toEqual([[50, 50], [250, 50], [250, 250], [50, 250]]);
  });

  it('turns by the knob above', () => {
    const bench = new Bench('transform', SQUARE);
    bench.drag([[150, 72], [190, 80], [228, 150]]);
    expect(bench.points).toEqual([[200, 100], [200, 200], [100, 200], [100, 100]]);
  });

  it('does nothing outside, or for a hand that trembles, or after Esc', () => {
    const bench = new Bench('transform', SQUARE);
    bench.drag([[300, 300], [350, 350]]);
    bench.drag([[150, 150], [151, 151]]);
    bench.send('down', [150, 150]);
    bench.send('move', [190, 150]);
    bench.send('cancel', [0, 0]);
    bench.send('up', [190, 150]);
    expect(bench.outline).toBe(SQUARE);
    expect(bench.history.past).toHaveLength(0);
  });
});

describe('marking a stretch', () => {
  it('marks what the hand goes along, round a corner, with points at both ends', () => {
    const bench = new Bench('stretch', SQUARE);
    bench.drag([[150, 102], [180, 98], [199, 105], [203, 150]]);
    expect(bench.points).toEqual([[100, 100], [150, 100], [200, 100], [200, 150], [200, 200], [100, 200]]);
    expect(bench.outline.unknownSides).toEqual([1, 2]);
    expect(bench.history.past).toHaveLength(1);
  });

  it('marks known again what it began on, backwards and over the first point', () => {
    const bench = new Bench('stretch', { ...SQUARE, unknownSides: [0, 1, 2, 3] });
    bench.drag([[130, 100], [110, 100], [100, 108], [100, 140]]);
    expect(bench.points).toEqual([[100, 100], [130, 100], [200, 100], [200, 200], [100, 200], [100, 140]]);
    expect(bench.outline.unknownSides).toEqual([1, 2, 3, 4]);
  });

  it('does not jump to the other side of a thin part', () => {
    const thin = outlineOf([[100, 100], [300, 100], [300, 104], [100, 104]]);
    const bench = new Bench('stretch', thin);
    bench.drag([[150, 99], [170, 101], [190, 103.5], [210, 103]]);
    expect(bench.points.filter(([, row]) => row === 104)).toHaveLength(2);
    expect(bench.outline.unknownSides).toEqual([1]);
    expect(bench.points[2]).toEqual([210, 100]);
  });

  it('toggles one side by a click, and leaves what is far away alone', () => {
    const bench = new Bench('stretch', SQUARE);
    bench.drag([[150, 150], [150, 160], [150, 190]]);
    expect(bench.outline).toBe(SQUARE);
    bench.drag([[198, 150]]);
    expect(bench.outline.unknownSides).toEqual([1]);
    bench.drag([[202, 160]]);
    expect(bench.outline.unknownSides).toEqual([]);
  });

  it('marks everything once round', () => {
    expect(markedStretch(SQUARE, { start: 20, extent: -400 }, true).unknownSides).toEqual([0, 1, 2, 3]);
    expect(perimeter(SQUARE.points)).toBe(400);
    expect(ahead(390, 10, 400)).toBe(20);
    expect(ahead(10, 390, 400)).toBe(-20);
  });

  it('ends at points that are there, where they are near', () => {
    const marked = markedStretch(SQUARE, { start: 99.8, extent: 100.5 }, true);
    expect(marked.points).toBe(SQUARE.points);
    expect(marked.unknownSides).toEqual([1]);
  });

  it('knows the points along it', () => {
    const along = pointsOf(SQUARE.points, { start: 350, extent: 100 });
    expect(along.map(({ column, row }) => [column, row])).toEqual([[100, 150], [100, 100], [150, 100]]);
  });
});

describe('sides that are unknown', () => {
  it('stay where a new course runs along them', () => {
    const course = outlineOf([[101, 101], [150, 99], [199, 101], [201, 199], [99, 201]]).points;
    expect(carriedSides({ ...SQUARE, unknownSides: [0] }, course)).toEqual([0, 1]);
    expect(carriedSides(SQUARE, course)).toEqual([]);
    expect(carriedSides({ ...SQUARE, unknownSides: [0] }, outlineOf([[100, 80], [200, 80], [150, 300]]).points)).toEqual([]);
  });

  it('follow what the core says of where points came from', () => {
    const old = { ...SQUARE, unknownSides: [1] };
    // Points 0 and 1 as they were, one on side 1, point 2 moved, point 3, one on side 3.
    expect(sidesFrom(old, [0, 1, 1.5, 2 + 1e-9, 3, 3.5])).toEqual([1, 2]);
    expect(sidesFrom(old, [-1, 1, 2, -1])).toEqual([1]);
    // A side that spans two old ones is what most of it was.
    expect(sidesFrom({ ...SQUARE, unknownSides: [3] }, [0, 1, 3])).toEqual([2]);
    expect(sidesFrom(SQUARE, [0, 1, 2, 3])).toEqual([]);
  });

  it('cut an outline into pieces', () => {
    const pieces = piecesOf({ ...SQUARE, unknownSides: [0, 3] });
    expect(pieces.map(({ unknown, points }) => [unknown, points.length])).toEqual([[false, 3], [true, 3]]);
    expect(pieces[0]!.points[0]).toEqual({ column: 200, row: 100 });
    expect(pieces[1]!.points.at(-1)).toEqual({ column: 200, row: 100 });
    expect(piecesOf(SQUARE)).toHaveLength(1);
  });
});

describe('rings', () => {
  it('go round clockwise as seen', () => {
    expect(clockwise(SQUARE.points)).toBe(true);
    expect(clockwise(SQUARE.points.toReversed())).toBe(false);
  });
});

describe('copying from another frame', () => {
  const frame = (id: string) => ({ id, name: id, source: 's', indexInSource: 0, width: 500, height: 500 });
  const open: Outline = { ...SQUARE, closed: false };
  const doc: Doc = {
    ...EMPTY_DOC,
    frames: ['a', 'b', 'c', 'd'].map(frame),
    cells: Cells.from(Object.entries({ 'a/femur': { ...EMPTY_CELL, outline: SQUARE }, 'b/femur': { ...EMPTY_CELL, outline: open }, 'd/tibia': { ...EMPTY_CELL, outline: SQUARE } })),
  };

  it('takes the nearest closed outline of the same component', () => {
    expect(tracedNeighbour(doc, 2, 'femur', -1)).toBe(0);
    expect(tracedNeighbour(doc, 2, 'femur', 1)).toBeNull();
    expect(tracedNeighbour(doc, 2, 'tibia', 1)).toBe(3);
  });

  it('copies its marks, and is another outline than the one it came from', () => {
    const marked = { ...SQUARE, unknownSides: [2] };
    const after = copyOutline({ frameId: 'c', component: 'femur' }, marked, 'frame 1').apply(doc);
    const copied = cellOf(after, 'c', 'femur').outline!;
    expect(copied).toEqual(marked);
    expect(copied).not.toBe(marked);
  });
});

describe('fingers', () => {
  const VIEW = { scale: 1, left: 0, top: 0 };

  it('draw with one, move and zoom with two, and do not draw with the last', () => {
    const touches = new Touches();
    expect(touches.down(1, canvasPoint(100, 100))).toBe('tool');
    expect(touches.move(1, canvasPoint(110, 100), VIEW)).toBeNull();
    expect(touches.down(2, canvasPoint(210, 100))).toBe('view');
    const zoomed = touches.move(2, canvasPoint(310, 100), VIEW)!;
    expect(zoomed.scale).toBeCloseTo(2, 9);
    // What lay between the fingers, at 160, stays between them, at 210.
    expect(160 * zoomed.scale + zoomed.left).toBeCloseTo(210, 9);
    expect(touches.up(2)).toBe(true);
    expect(touches.move(1, canvasPoint(120, 110), VIEW)).toEqual({ scale: 1, left: 10, top: 10 });
    expect(touches.up(1)).toBe(true);
    expect(touches.down(3, canvasPoint(0, 0))).toBe('tool');
    expect(touches.up(3)).toBe(false);
  });

  it('leave drawing to a pen once there was one', () => {
    const touches = new Touches();
    touches.pen();
    expect(touches.down(1, canvasPoint(0, 0))).toBe('view');
  });

  it('ignore a third', () => {
    const touches = new Touches();
    touches.down(1, canvasPoint(0, 0));
    touches.down(2, canvasPoint(10, 0));
    expect(touches.down(3, canvasPoint(20, 0))).toBe('nothing');
  });
});

describe('an outline by one click', () => {
  const other = outlineOf([[110, 110], [190, 110], [150, 190]]);
  const candidate = (z: number): MatchedCandidate => ({
    pose: { x: 0, y: 0, z, zRot: 0, xRot: 0, yRot: 0 },
    unmatched: null,
    drawn: 10,
    residual: 0.2,
    deviations: null,
    judged: null,
    start: null,
    atBorder: false,
    picture: null,
  });
  const match: Match = {
    candidates: [candidate(-1000), candidate(-1100)],
    canonicalSize: 256,
    canonicalArea: 15000,
    clipped: false,
    partial: false,
    reason: 'It fits.',
    decided: false,
    verdict: { word: 'doubtful', because: 'a part is hidden' },
    refusal: null,
    milliseconds: 1,
  };
  const answer = (match: Match | null, sentence: string): Answer => ({ match, sentence, supports: [0.9, 0.7], onFrame: { film: null } });
  const found = oneClickOutline(PLACE, [SQUARE, other], answer(match, 'It fits.'), 'key').apply(EMPTY_DOC);
  const cell = (doc: Doc) => cellOf(doc, 'f', 'femur');

  it('comes with its pose', () => {
    expect(cell(found)).toMatchObject({ outline: SQUARE, resultOf: SQUARE, result: { kind: 'posed', origin: 'key', chosen: 0, onFrame: { film: null }, candidates: [{ support: 0.9 }, { support: 0.7 }] } });
    expect(verdictOf(cell(found).result)).toEqual({ word: 'doubtful', because: 'a part is hidden' });
  });

  it('has no pose where nothing fits, and says what to do', () => {
    const sentence = 'That is little: click elsewhere.';
    const refused = oneClickOutline(PLACE, [SQUARE, other], answer({ ...match, verdict: null, refusal: 'no fit' }, sentence), 'key').apply(EMPTY_DOC);
    expect(cell(refused)).toMatchObject({ outline: SQUARE, resultOf: SQUARE, result: { kind: 'failed', origin: 'key', sentence } });
  });

  it('changes with the candidate, and back', () => {
    const second = chooseCandidate(PLACE, 1).apply(found);
    expect(cell(second).outline).toBe(other);
    expect(cell(second).resultOf).toBe(other);
    expect(cell(chooseCandidate(PLACE, 0).apply(second)).outline).toBe(SQUARE);
  });

  it('stays what somebody made of it', () => {
    const edited = movePoint(PLACE, 0, framePoint(90, 90)).apply(found);
    const mine = cell(edited).outline;
    expect(cell(chooseCandidate(PLACE, 1).apply(edited)).outline).toBe(mine);
  });

  it('is an outline like any other where no model led to it', () => {
    expect(cell(oneClickOutline(PLACE, [SQUARE], answer(null, ''), null).apply(EMPTY_DOC))).toMatchObject({ outline: SQUARE, result: null });
  });
});
