import { describe, expect, it } from 'vitest';
import { firstCrossing, withoutLoops } from '../../src/geometry/loops';
import { framePoint } from '../../src/geometry/points';

const ring = (places: readonly (readonly [number, number])[], unknownSides: readonly number[] = []) => ({
  points: places.map(([column, row]) => framePoint(column, row)),
  unknownSides,
  closed: true,
});

describe('loops of an outline', () => {
  it('one that does not cross itself stays the same object, touching sides or not', () => {
    const square = ring([[0, 0], [10, 0], [10, 10], [0, 10]]);
    expect(withoutLoops(square)).toBe(square);
    const touching = ring([[0, 0], [10, 0], [10, 10], [5, 0], [0, 10]]);
    expect(withoutLoops(touching)).toBe(touching);
  });

  it('the smaller loop is cut off where the sides cross, and marks stay with their sides', () => {
    // A square whose lower right corner is tied into a knot of one pixel.
    const knotted = ring([[0, 0], [10, 0], [10, 9], [9, 11], [11, 11], [9, 9], [0, 9]], [2, 3, 6]);
    expect(firstCrossing(knotted.points)).not.toBeNull();
    const plain = withoutLoops(knotted);
    expect(firstCrossing(plain.points)).toBeNull();
    expect(plain.points).not.toContainEqual(framePoint(11, 11));
    for (const corner of [[0, 0], [10, 0], [0, 9]] as const) expect(plain.points).toContainEqual(framePoint(corner[0], corner[1]));
    const left = plain.points.findIndex(({ column, row }) => column === 0 && row === 9);
    expect(plain.unknownSides).toContain(left);
    expect(plain.closed).toBe(true);
  });

  it('all of several loops are cut off, wherever the outline begins', () => {
    const knots: (readonly [number, number])[] = [[0, 0], [20, 0], [22, 2], [22, 0], [20, 2], [20, 20], [22, 22], [20, 22], [22, 20], [0, 20]];
    for (let shift = 0; shift < knots.length; shift++) {
      const plain = withoutLoops(ring([...knots.slice(shift), ...knots.slice(0, shift)]));
      expect(firstCrossing(plain.points)).toBeNull();
      expect(plain.points).toContainEqual(framePoint(0, 0));
      expect(plain.points).toContainEqual(framePoint(0, 20));
    }
  });
});
