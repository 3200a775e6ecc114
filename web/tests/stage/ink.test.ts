import { describe, expect, it } from 'vitest';
import { canvasPoint } from '../../src/geometry/points';
import { boxRound } from '../../src/stage/ink';

const STAGE = { width: 1000, height: 620.5 };
const box = (...points: (readonly [number, number])[]) => boxRound(points.map(([x, y]) => canvasPoint(x, y)), STAGE);

describe('the part of the stage that is drawn on', () => {
  it('holds every point with room for its handle, in whole steps', () => {
    const { left, top, width, height } = box([300.2, 250], [420, 333.3]);
    expect(left).toBeLessThanOrEqual(300.2 - 16);
    expect(top).toBeLessThanOrEqual(250 - 16);
    expect(left + width).toBeGreaterThanOrEqual(420 + 16);
    expect(top + height).toBeGreaterThanOrEqual(333.3 + 16);
    expect([left, top, width, height].every((length) => length % 64 === 0)).toBe(true);
  });

  it('does not move while a point moves a little', () => {
    expect(box([300, 250], [420, 333])).toEqual(box([301, 252], [419, 331]));
  });

  it('ends where the stage ends', () => {
    expect(box([-500, -20], [5000, 700])).toEqual({ left: 0, top: 0, width: 1000, height: 621 });
  });

  it.each([['nothing is drawn', []], ['all of it is beside the stage', [[-900, -900]]]] as const)('is next to nothing where %s', (_, points) => {
    expect(box(...points)).toEqual({ left: 0, top: 0, width: 1, height: 1 });
  });
});
