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
