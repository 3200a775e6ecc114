import { describe, expect, it } from 'vitest';
import { deletePoint, insertPoint, toggleUnknownSide, withCell } from '../../src/document/commands';
import * as history from '../../src/document/history';
import { unknownFraction } from '../../src/document/sides';
import { cellOf, EMPTY_CELL, EMPTY_DOC, type Outline } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import { sideMeant } from '../../src/interaction/hit';

const place = { frameId: 'f', component: 'femur' } as const;

/** A hexagon whose points are told apart by their columns. */
function marked(...unknownSides: number[]): Outline {
  const points = [0, 10, 20, 30, 40, 50].map((column) => framePoint(column, column * (50 - column)));
  return { points, closed: true, unknownSides };
}

function after(outline: Outline, ...commands: ReturnType<typeof toggleUnknownSide>[]): Outline {
  const doc = withCell(EMPTY_DOC, place, { ...EMPTY_CELL, outline });
  const done = commands.reduce((doc, command) => command.apply(doc), doc);
  return cellOf(done, 'f', 'femur').outline as Outline;
}

/** The sides that are unknown, by the columns of their ends. */
function ends({ points, unknownSides }: Outline): string[] {
  const column = (index: number) => points[index % points.length]?.column;
  return unknownSides.map((side) => `${column(side)}-${column(side + 1)}`);
}

describe('sides that are marked unknown', () => {
  it('are marked and unmarked, each time as one undo unit', () => {
    let h = history.startHistory(withCell(EMPTY_DOC, place, { ...EMPTY_CELL, outline: marked() }));
    const sides = () => cellOf(h.present, 'f', 'femur').outline?.unknownSides;
    for (const side of [4, 1, 4]) h = history.perform(h, toggleUnknownSide(place, side));
    expect(sides()).toEqual([1]);
    h = history.undo(h);
    expect(sides()).toEqual([1, 4]);
    h = history.undo(history.undo(h));
    expect(sides()).toEqual([]);
    expect(history.redo(h).present).not.toBe(h.present);
  });

  it('do not exist beyond the outline', () => {
    const outline = marked(2);
    expect(after(outline, toggleUnknownSide(place, 6))).toBe(outline);
  });

  it.each([
    [0, ['0-10', '20-30', '50-99', '99-0']],
    [1, ['0-99', '99-10', '20-30', '50-0']],
    [2, ['0-10', '20-30', '50-0']],
    [3, ['0-10', '20-99', '99-30', '50-0']],
    [6, ['0-10', '20-30', '50-99', '99-0']],
  ])('are both halves of a side that a point before %i splits', (index, wanted) => {
    const outline = after(marked(0, 2, 5), insertPoint(place, index, framePoint(99, 99)));
    expect(ends(outline).sort()).toEqual([...wanted].sort());
    expect(outline.unknownSides).toEqual([...outline.unknownSides].sort((a, b) => a - b));
  });

  it.each([
    [0, ['20-30', '50-10']],
    [1, ['0-20', '20-30', '50-0']],
    [2, ['0-10', '10-30', '50-0']],
    [4, ['0-10', '20-30', '50-0']],
    [5, ['0-10', '20-30', '40-0']],
  ])('join into one where point %i is deleted', (index, wanted) => {
    expect(ends(after(marked(0, 2, 5), deletePoint(place, index))).sort()).toEqual([...wanted].sort());
  });

  it('have a fraction of the outline by length', () => {
    const points = [framePoint(0, 0), framePoint(30, 0), framePoint(30, 20), framePoint(0, 20)];
    expect(unknownFraction({ points, closed: true, unknownSides: [0, 1] })).toBe(0.5);
    expect(unknownFraction({ points, closed: true, unknownSides: [] })).toBe(0);
  });
});

describe('the side that is meant', () => {
  it.each([
    ['the edge under the pointer', { kind: 'edge', before: 3, at: framePoint(0, 0) } as const, 1, 2],
    ['the edge that closes the outline', { kind: 'edge', before: 6, at: framePoint(0, 0) } as const, null, 5],
    ['the side after the selected point', { kind: 'vertex', index: 4 } as const, 1, 1],
    ['the side after the point under the pointer', { kind: 'vertex', index: 4 } as const, null, 4],
    ['none', { kind: 'nothing' } as const, null, null],
  ])('is %s', (_, hit, selected, wanted) => {
    expect(sideMeant(hit, selected, 6)).toBe(wanted);
  });
});
