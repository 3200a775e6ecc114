import { clockwise } from '../geometry/rings';
import type { Outline } from '../document/types';
import type { FramePoint } from '../geometry/points';
import type { FrameImage } from '../pkg/page/fluoropose_page.js';
import { snapped, snappedPath, type Reshape } from './pixels';

/**
 * A closed outline pulled to the edges near it. Stretches that are marked unknown stay where they are: what hides the
 * implant there has edges of its own.
 */
export function snappedOutline(image: FrameImage, outline: Outline, dark: boolean, reach: number): Reshape {
  if (outline.unknownSides.length === 0) return snapped(image, outline, dark, reach);
  if (outline.unknownSides.length === outline.points.length) {
    return { points: outline.points, unknownSides: outline.unknownSides, greatest: 0, rms: 0 };
  }
  const side = clockwise(outline.points) ? 1 : -1;
  const pieces = piecesOf(outline).map(({ points, unknown }) =>
    unknown ? { points, unknown, greatest: 0, rms: 0 } : { ...snappedPath(image, points, side, dark, reach), unknown },
  );
  return joined(pieces);
}

interface Piece {
  readonly points: readonly FramePoint[];
  readonly unknown: boolean;
}

/** Runs of sides that are known or unknown alike, from where such a run begins; each with both its ends. */
export function piecesOf({ points, unknownSides }: Outline): readonly Piece[] {
  const count = points.length;
  const isUnknown = (side: number) => unknownSides.includes((side + count) % count);
  const first = Math.max(0, points.findIndex((_, side) => isUnknown(side) !== isUnknown(side - 1)));
  const pieces: { points: FramePoint[]; unknown: boolean }[] = [];
  for (let step = 0; step < count; step++) {
    const side = (first + step) % count;
    const last = pieces.at(-1);
    const end = points[(side + 1) % count]!;
    if (last && last.unknown === isUnknown(side)) last.points.push(end);
    else pieces.push({ points: [points[side]!, end], unknown: isUnknown(side) });
  }
  return pieces;
}

function joined(pieces: readonly (Piece & { readonly greatest: number; readonly rms: number })[]): Reshape {
  const points: FramePoint[] = [];
  const unknownSides: number[] = [];
  let squares = 0;
  for (const piece of pieces) {
    const sides = piece.points.length - 1;
    if (piece.unknown) unknownSides.push(...Array.from({ length: sides }, (_, side) => points.length + side));
    points.push(...piece.points.slice(0, -1));
    squares += piece.rms ** 2 * sides;
  }
  const greatest = Math.max(...pieces.map((piece) => piece.greatest));
  return { points, unknownSides, greatest, rms: Math.sqrt(squares / points.length) };
}
