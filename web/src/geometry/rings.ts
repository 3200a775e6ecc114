import type { FramePoint } from './points';

/** Does a closed outline go round clockwise, as it is seen on the screen? Then its inside is on the right hand. */
export function clockwise(points: readonly FramePoint[]): boolean {
  return twiceArea(points) > 0;
}

function twiceArea(points: readonly FramePoint[]): number {
  return points.reduce((sum, { column, row }, index) => {
    const next = points[(index + 1) % points.length]!;
    return sum + column * next.row - next.column * row;
  }, 0);
}

/** By parity: a point inside is cut off from afar by an odd number of sides. */
export function isInside(points: readonly FramePoint[], { column, row }: FramePoint): boolean {
  return points.reduce((inside, a, index) => {
    const b = points[(index + 1) % points.length]!;
    const crosses = a.row > row !== b.row > row && column < a.column + ((row - a.row) / (b.row - a.row)) * (b.column - a.column);
    return crosses ? !inside : inside;
  }, false);
}
