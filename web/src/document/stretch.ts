import type { FramePoint } from '../geometry/points';
import { framePoint } from '../geometry/points';
import { sidesAfterInsertion } from './sides';
import type { Outline } from './types';

/**
 * Stretches of a closed outline, told by length along it: `start` pixels from point 0, and how far from there, negative
 * against the order of the points.
 */
export interface Stretch {
  readonly start: number;
  readonly extent: number;
}

/** A stretch ends at a point that is there already, where one is this near, px. */
const SAME_POINT = 0.75;

/** Marks a stretch as unknown or as known. Its ends become points of the outline. */
export function markedStretch(outline: Outline, { start, extent }: Stretch, unknown: boolean): Outline {
  const length = perimeter(outline.points);
  if (length === 0) return outline;
  if (Math.abs(extent) > length - 2 * SAME_POINT) return { ...outline, unknownSides: unknown ? outline.points.map((_, side) => side) : [] };
  const from = wrapped(Math.min(start, start + extent), length);
  const to = wrapped(Math.max(start, start + extent), length);
  const first = splitAt(outline, from);
  const last = splitAt(first.outline, to);
  const inserted = last.outline !== first.outline && last.index <= first.index;
  const begin = inserted ? first.index + 1 : first.index;
  return withSides(last.outline, sidesBetween(begin, last.index, last.outline.points.length), unknown);
}

/** How far along the outline each point is, and at the end its whole length, px. */
export function lengthsAlong(points: readonly FramePoint[]): readonly number[] {
  const lengths = [0];
  points.forEach((point, index) => {
    const next = points[(index + 1) % points.length] ?? point;
    lengths.push((lengths[index] ?? 0) + Math.hypot(next.column - point.column, next.row - point.row));
  });
  return lengths;
}

export function perimeter(points: readonly FramePoint[]): number {
  return lengthsAlong(points).at(-1) ?? 0;
}

/** The points of a stretch, its ends included, for drawing. */
export function pointsOf(points: readonly FramePoint[], { start, extent }: Stretch): readonly FramePoint[] {
  const lengths = lengthsAlong(points);
  const length = lengths.at(-1) ?? 0;
  if (length === 0) return [];
  const [from, to] = [Math.min(start, start + extent), Math.max(start, start + extent)];
  const between = [-1, 0, 1].flatMap((turn) =>
    points.flatMap((point, index) => {
      const at = (lengths[index] ?? 0) + turn * length;
      return at > from && at < to ? [{ at, point }] : [];
    }),
  );
  const along = between.sort((a, b) => a.at - b.at).map(({ point }) => point);
  return [pointAt(points, lengths, wrapped(from, length)), ...along, pointAt(points, lengths, wrapped(to, length))];
}

/** How far `to` lies ahead of `from` on a ring, the short way round. */
export function ahead(from: number, to: number, length: number): number {
  const forth = wrapped(to - from, length);
  return forth > length / 2 ? forth - length : forth;
}

export function wrapped(at: number, length: number): number {
  const rest = at % length;
  return rest < 0 ? rest + length : rest;
}

function pointAt(points: readonly FramePoint[], lengths: readonly number[], at: number): FramePoint {
  const side = sideAt(lengths, at);
  const [from, to] = [points[side]!, points[(side + 1) % points.length]!];
  const whole = (lengths[side + 1] ?? 0) - (lengths[side] ?? 0);
  const part = whole > 0 ? (at - (lengths[side] ?? 0)) / whole : 0;
  return framePoint(from.column + part * (to.column - from.column), from.row + part * (to.row - from.row));
}

function sideAt(lengths: readonly number[], at: number): number {
  const next = lengths.findIndex((length) => length > at);
  return next < 0 ? lengths.length - 2 : next - 1;
}

/** The outline with a point at a place along it, and that point's number. */
function splitAt(outline: Outline, at: number): { outline: Outline; index: number } {
  const { points } = outline;
  const lengths = lengthsAlong(points);
  const near = lengths.findIndex((length) => Math.abs(length - at) <= SAME_POINT);
  if (near >= 0) return { outline, index: near % points.length };
  const index = sideAt(lengths, at) + 1;
  const point = pointAt(points, lengths, at);
  const unknownSides = sidesAfterInsertion(outline, index);
  return { outline: { ...outline, points: points.toSpliced(index, 0, point), unknownSides }, index };
}

function sidesBetween(begin: number, end: number, count: number): readonly number[] {
  const sides = [];
  for (let side = begin; side !== end; side = (side + 1) % count) sides.push(side);
  return sides;
}

function withSides(outline: Outline, marked: readonly number[], unknown: boolean): Outline {
  const others = outline.unknownSides.filter((side) => !marked.includes(side));
  const unknownSides = unknown ? [...others, ...marked].sort((a, b) => a - b) : others;
  return { ...outline, unknownSides };
}
