import { describe, expect, it } from 'vitest';
import * as history from '../../src/document/history';
import { cellOf, EMPTY_DOC, type Outline } from '../../src/document/types';
import { canvasPoint, framePoint } from '../../src/geometry/points';
import { Controller } from '../../src/interaction/controller';
import { hint } from '../../src/interaction/hints';
import { hitDraft, hitTest } from '../../src/interaction/hit';
import type { Button, Effect, Input, Situation } from '../../src/interaction/machine';
import { draggedWindow, wheelZoom } from '../../src/interaction/navigate';
import type { ToolName } from '../../src/terms/tool';

/** The stage without a DOM: a controller, a history, and a frame shown at twice its size. */
class Bench {
  readonly controller = new Controller();
  history = history.startHistory(EMPTY_DOC);
  viewport = { scale: 2, left: 0, top: 0 };
  selected: number | null = null;
  tool: ToolName = 'trace';
  space = false;

  get outline(): Outline | null {
    return cellOf(this.history.present, 'f', 'femur').outline;
  }

  get columns(): number[] {
    return this.outline?.points.map((p) => p.column) ?? [];
  }

  send(type: Input['type'], x: number, y: number, button: Button = 'primary', alt = false): void {
    const situation: Situation = {
      viewport: this.viewport,
      frame: { width: 500, height: 500 },
      place: { frameId: 'f', component: 'femur' },
      outline: this.outline,
      window: { centre: 100, width: 200 },
      erase: false,
    };
    const input = { type, at: canvasPoint(x, y), button, alt };
    for (const effect of this.controller.handle(this.tool, input, situation, this.space)) this.#apply(effect);
  }

  click(x: number, y: number, alt = false): void {
    this.send('down', x, y, 'primary', alt);
    this.send('up', x, y, 'primary', alt);
  }

  drag(from: [number, number], to: [number, number], button: Button = 'primary'): void {
    this.send('down', ...from, button);
    this.send('move', (from[0] + to[0]) / 2, (from[1] + to[1]) / 2, button);
    this.send('move', ...to, button);
    this.send('up', ...to, button);
  }

  square(): this {
    this.click(100, 100);
    this.click(300, 100);
    this.click(300, 300);
    this.click(100, 300);
    this.click(101, 99);
    return this;
  }

  #apply(effect: Effect): void {
    if (effect.type === 'perform') this.history = history.perform(this.history, effect.command);
    if (effect.type === 'preview') this.history = history.preview(this.history, effect.command);
    if (effect.type === 'cancel-preview') this.history = history.cancelPreview(this.history);
    if (effect.type === 'select') this.selected = effect.index;
    if (effect.type === 'viewport') this.viewport = { ...effect.viewport };
    if (effect.type === 'commit') {
      this.history = history.commitPreview(history.preview(this.history, effect.command), effect.command);
    }
  }
}

describe('tracing', () => {
  it('sets points by clicks and closes on the first', () => {
    const bench = new Bench().square();
    expect(bench.columns).toEqual([50, 150, 150, 50]);
    expect(bench.outline?.closed).toBe(true);
    expect(bench.history.past.length).toBe(5);
    expect(bench.selected).toBeNull();
  });

  it('lets a new point be dragged into place before the button is let go', () => {
    const bench = new Bench();
    bench.drag([100, 100], [140, 120]);
    expect(bench.outline?.points).toEqual([{ column: 70, row: 60 }]);
    expect(bench.history.past.length).toBe(1);
  });

  it('closes by a double click without a second point on the same spot', () => {
    const bench = new Bench();
    bench.click(100, 100);
    bench.click(300, 100);
    bench.click(300, 300);
    bench.click(300, 300);
    bench.send('double', 300, 300);
    expect(bench.columns).toEqual([50, 150, 150]);
    expect(bench.outline?.closed).toBe(true);
  });

  it('does not close two points', () => {
    const bench = new Bench();
    bench.click(100, 100);
    bench.click(300, 100);
    bench.click(100, 100);
    bench.send('double', 100, 100);
    expect(bench.outline).toMatchObject({ closed: false });
    expect(bench.columns).toEqual([50, 150]);
  });

  it('takes points set close together, each of them', () => {
    const bench = new Bench();
    for (let x = 100; x <= 130; x += 2) bench.click(x, 200);
    expect(bench.columns.length).toBe(16);
    bench.click(130.5, 200);
    expect(bench.columns.length).toBe(16);
  });

  it('moves a point of the draft', () => {
    const bench = new Bench();
    bench.click(100, 100);
    bench.click(300, 100);
    bench.drag([301, 100], [341, 140]);
    expect(bench.outline?.points).toEqual([
      { column: 50, row: 50 },
      { column: 170, row: 70 },
    ]);
    expect(bench.outline?.closed).toBe(false);
  });

  it('goes on with the draft after another tool', () => {
    const bench = new Bench();
    bench.click(100, 100);
    bench.tool = 'hand';
    bench.drag([10, 10], [20, 10]);
    bench.tool = 'trace';
    bench.click(310, 100);
    expect(bench.columns).toEqual([50, 150]);
  });

  it('takes a cancelled gesture back', () => {
    const bench = new Bench();
    bench.click(100, 100);
    bench.send('down', 200, 200);
    bench.send('cancel', 200, 200);
    expect(bench.columns).toEqual([50]);
    expect(bench.controller.busy).toBe(false);
  });
});

describe('editing', () => {
  it('moves a vertex by as much as the hand, wherever it was gripped', () => {
    const bench = new Bench().square();
    bench.drag([303, 102], [323, 112]);
    expect(bench.outline?.points[1]).toEqual({ column: 160, row: 55 });
  });

  it('leaves a vertex where it is when the hand only trembles', () => {
    const bench = new Bench().square();
    const before = bench.outline;
    bench.drag([300, 100], [301, 101]);
    expect(bench.outline).toBe(before);
    expect(bench.selected).toBe(1);
  });

  it('inserts on an edge and drags the new point on, as one undo unit', () => {
    const bench = new Bench().square();
    const steps = bench.history.past.length;
    bench.drag([200, 300], [200, 340]);
    expect(bench.outline?.points[3]).toEqual({ column: 100, row: 170 });
    expect(bench.history.past.length).toBe(steps + 1);
  });

  it('inserts on the edge that closes the outline', () => {
    const bench = new Bench().square();
    bench.click(100, 200);
    expect(bench.columns).toEqual([50, 150, 150, 50, 50]);
  });

  it('deletes by Alt-click', () => {
    const bench = new Bench().square();
    bench.click(300, 300, true);
    expect(bench.columns).toEqual([50, 150, 50]);
  });

  it('adds nothing to a closed outline by a click beside it', () => {
    const bench = new Bench().square();
    bench.click(400, 400);
    expect(bench.columns.length).toBe(4);
  });
});

describe('navigation', () => {
  it('pans with the middle button whatever the tool', () => {
    const bench = new Bench();
    bench.drag([100, 100], [130, 80], 'middle');
    expect(bench.viewport).toEqual({ scale: 2, left: 30, top: -20 });
    expect(bench.outline).toBeNull();
  });

  it('pans with the space bar held and traces nothing', () => {
    const bench = new Bench();
    bench.space = true;
    bench.drag([100, 100], [90, 100]);
    expect(bench.viewport.left).toBe(-10);
    expect(bench.outline).toBeNull();
  });

  it('windows with the right button, as one undo unit', () => {
    const bench = new Bench();
    bench.drag([100, 100], [400, 250], 'secondary');
    expect(bench.history.present.window).toEqual({ centre: 0, width: 400 });
    expect(bench.history.past.length).toBe(1);
  });

  it('changes nothing by a right click without a drag', () => {
    const bench = new Bench();
    bench.drag([100, 100], [100, 100], 'secondary');
    expect(bench.history.past.length).toBe(0);
  });

  it('never makes a window without width', () => {
    expect(draggedWindow({ centre: 5, width: 1 }, canvasPoint(-4000, 0)).width).toBe(1);
  });

  it('limits what one wheel event does', () => {
    const view = { scale: 1, left: 0, top: 0 };
    expect(wheelZoom(view, canvasPoint(0, 0), 1e6).scale).toBeGreaterThan(0.5);
  });
});

describe('hit tests', () => {
  const viewport = { scale: 1, left: 0, top: 0 };
  const outline = new Bench().square().outline;

  it('prefers a vertex to the edges that meet there', () => {
    expect(hitTest(outline, viewport, canvasPoint(54, 50))).toEqual({ kind: 'vertex', index: 0 });
  });

  it('finds no edges while drafting', () => {
    expect(hitTest(outline, viewport, canvasPoint(100, 52)).kind).toBe('edge');
    expect(hitDraft(outline, viewport, canvasPoint(100, 52)).kind).toBe('nothing');
  });

  it('has the first point easier to hit than the others while drafting', () => {
    expect(hitDraft(outline, viewport, canvasPoint(55, 50)).kind).toBe('vertex');
    expect(hitDraft(outline, viewport, canvasPoint(155, 50)).kind).toBe('nothing');
  });
});

describe('a finger', () => {
  it('reaches twice as far as a mouse', () => {
    const outline: Outline = { points: [framePoint(10, 10), framePoint(110, 10), framePoint(60, 90)], closed: true, unknownSides: [] };
    const viewport = { scale: 1, left: 0, top: 0 };
    expect(hitTest(outline, viewport, canvasPoint(10, 25)).kind).toBe('nothing');
    expect(hitTest(outline, viewport, canvasPoint(10, 25), 2)).toEqual({ kind: 'vertex', index: 0 });
  });
});

describe('the line below', () => {
  it('asks for nothing that is done', () => {
    const situation = { erase: false, adjusting: false, posed: true };
    const nothing = { kind: 'nothing' } as const;
    expect(hint('one-click', 'tibia', null, nothing, { ...situation, posed: false })).toMatch(/^Click inside the tibia/);
    expect(hint('one-click', 'tibia', null, nothing, situation)).toBe('A click inside the tibia finds it anew.');
    for (const tool of ['edit', 'trace'] as const) expect(hint(tool, 'femur', null, nothing, situation)).toMatch(/^The femur has a pose here and no outline: A moves/);
    expect(hint('trace', 'femur', null, nothing, { ...situation, posed: false })).toMatch(/to begin its outline/);
  });
});
