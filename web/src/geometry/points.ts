/**
 * Points are typed by the space they live in, so that one can never stand for the other by accident.
 *
 * - Frame space: the core's continuous image coordinates. `column` grows to the right, `row` down, the first
 *   pixel covers [0, 1) x [0, 1).
 * - Canvas space: CSS pixels from the canvas's upper left corner.
 */
declare const space: unique symbol;

export interface FramePoint {
  readonly column: number;
  readonly row: number;
  readonly [space]: 'frame';
}

export interface CanvasPoint {
  readonly x: number;
  readonly y: number;
  readonly [space]: 'canvas';
}

export function framePoint(column: number, row: number): FramePoint {
  return { column, row } as FramePoint;
}

export function pointsFrom(numbers: ArrayLike<number>): readonly FramePoint[] {
  return Array.from({ length: numbers.length / 2 }, (_, index) => framePoint(numbers[2 * index]!, numbers[2 * index + 1]!));
}

export function canvasPoint(x: number, y: number): CanvasPoint {
  return { x, y } as CanvasPoint;
}

export function distance(a: CanvasPoint, b: CanvasPoint): number {
  return Math.hypot(a.x - b.x, a.y - b.y);
}

/** The point of the segment a-b nearest to p. */
export function nearestOnSegment(p: CanvasPoint, a: CanvasPoint, b: CanvasPoint): CanvasPoint {
  const dx = b.x - a.x;
  const dy = b.y - a.y;
  const lengthSquared = dx * dx + dy * dy;
  if (lengthSquared === 0) return a;
  const t = Math.min(1, Math.max(0, ((p.x - a.x) * dx + (p.y - a.y) * dy) / lengthSquared));
  return canvasPoint(a.x + t * dx, a.y + t * dy);
}
