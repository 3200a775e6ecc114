import type { FramePoint } from '../geometry/points';
import type { Outline } from './types';

/** Sides that are marked unknown, while points come and go. A side has the number of the point that it begins at. */

/** A new point before `index` splits a side: both halves are what it was. */
export function sidesAfterInsertion({ points, unknownSides }: Outline, index: number): readonly number[] {
  const count = points.length;
  const split = (Math.min(index, count) - 1 + count) % count;
  const halves = index === 0 ? [0, count] : [split, split + 1];
  const moved = unknownSides.flatMap((side) => (side === split ? halves : [side < index ? side : side + 1]));
  return moved.sort((a, b) => a - b);
}

/** The sides before and after a deleted point become one, which is as unknown as either was. */
export function sidesAfterDeletion({ points, unknownSides }: Outline, index: number): readonly number[] {
  const count = points.length;
  const before = (index - 1 + count) % count;
  const joined = index === 0 ? count - 2 : before;
  const moved = unknownSides.map((side) => (side === index || side === before ? joined : side > index ? side - 1 : side));
  return [...new Set(moved)].sort((a, b) => a - b);
}

/** Part of the outline's length that is unknown, 0 to 1. */
export function unknownFraction({ points, unknownSides }: Outline): number {
  const lengths = points.map((point, side) => {
    const next = points[(side + 1) % points.length] ?? point;
    return Math.hypot(next.column - point.column, next.row - point.row);
  });
  const all = lengths.reduce((sum, length) => sum + length, 0);
  const unknown = unknownSides.reduce((sum, side) => sum + (lengths[side] ?? 0), 0);
  return all > 0 ? unknown / all : 0;
}

/** How far a new side may run from an unknown one and still be it, px. */
const SAME_COURSE = 3;

/** The sides of a new course that run along unknown sides of the old one. */
export function carriedSides(old: Outline, points: readonly FramePoint[]): readonly number[] {
  if (old.unknownSides.length === 0) return [];
  return points.flatMap((point, side) => {
    const next = points[(side + 1) % points.length] ?? point;
    const middle = { column: (point.column + next.column) / 2, row: (point.row + next.row) / 2 };
    const nearest = old.points.map((_, other) => awayFromSide(old.points, other, middle));
    const best = nearest.indexOf(Math.min(...nearest));
    return old.unknownSides.includes(best) && (nearest[best] ?? Infinity) <= SAME_COURSE ? [side] : [];
  });
}

function awayFromSide(points: readonly FramePoint[], side: number, p: { column: number; row: number }): number {
  const from = points[side]!;
  const to = points[(side + 1) % points.length]!;
  const [dx, dy] = [to.column - from.column, to.row - from.row];
  const squared = dx * dx + dy * dy;
  const along = squared === 0 ? 0 : ((p.column - from.column) * dx + (p.row - from.row) * dy) / squared;
  const t = Math.min(1, Math.max(0, along));
  return Math.hypot(p.column - from.column - t * dx, p.row - from.row - t * dy);
}
