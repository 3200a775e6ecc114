import type { Outline } from '../document/types';
import { type FramePoint, pointsFrom } from '../geometry/points';
import {
  brushOutline,
  Cooling,
  LiveWire,
  simplifyOutline,
  smoothOutline,
  snapOutline,
  snapPath,
  ThresholdTool,
  type FrameImage,
  type Reshaped,
} from '../pkg/page/fluoropose_page.js';

/** What a tool made of an outline. */
export interface Reshape {
  readonly points: readonly FramePoint[];
  /** Sides that come from unknown ones. */
  readonly unknownSides: readonly number[];
  /** Distances between the shapes before and after, px. */
  readonly greatest: number;
  readonly rms: number;
}

/** Outlines come out with points as sparse as this allows, px: far less than anybody's hand errs. */
export const TOLERANCE = 0.25;

/** As the core wants them: columns and rows by turns. */
export function flat(points: readonly FramePoint[]): Float64Array<ArrayBuffer> {
  return Float64Array.from(points.flatMap(({ column, row }) => [column, row]));
}

/** Reads an answer of the core and gives its memory back. */
function taken(reshaped: Reshaped, old: Outline | null): Reshape {
  try {
    const points = pointsFrom(reshaped.points);
    const unknownSides = old ? sidesFrom(old, reshaped.from) : [];
    return { points, unknownSides, greatest: reshaped.maxError, rms: reshaped.rmsError };
  } finally {
    reshaped.free();
  }
}

/**
 * Which new sides come from unknown ones: `from` tells of each new point where on the old outline it was, in points and
 * parts of sides, or -1.
 */
export function sidesFrom(old: Outline, from: ArrayLike<number>): readonly number[] {
  const count = old.points.length;
  if (old.unknownSides.length === 0 || count === 0) return [];
  const unknown = new Set(old.unknownSides);
  return Array.from(from).flatMap((begin, side) => {
    const end = from[(side + 1) % from.length] ?? -1;
    if (begin < 0 && end < 0) return [];
    // Where only one end comes from the old outline, the side runs into it or out of it.
    const along = begin < 0 ? end - 0.5 : end < 0 ? begin : begin + ((end - begin + count) % count) / 2;
    const middle = Math.floor((along + count) % count);
    return unknown.has(middle) ? [side] : [];
  });
}

export function brushed(outline: Outline | null, stroke: readonly FramePoint[], radius: number, erase: boolean): Reshape {
  return taken(brushOutline(flat(outline?.points ?? []), flat(stroke), radius, !erase), outline);
}

export function simplified(outline: Outline, tolerance: number): Reshape {
  return taken(simplifyOutline(flat(outline.points), tolerance), outline);
}

export function smoothed(outline: Outline, sigma: number, tolerance: number): Reshape {
  return taken(smoothOutline(flat(outline.points), sigma, tolerance), outline);
}

export function snapped(image: FrameImage, outline: Outline, dark: boolean, reach: number): Reshape {
  return taken(snapOutline(image, flat(outline.points), dark, reach, TOLERANCE), outline);
}

/** An open path at the edges near it; its ends stay. `side`: +1 the implant is on the right hand, -1 on the left, 0 either. */
export function snappedPath(image: FrameImage, path: readonly FramePoint[], side: number, dark: boolean, reach: number, tolerance = TOLERANCE): Reshape {
  return taken(snapPath(image, flat(path), side, dark, reach, tolerance), null);
}

export interface Region {
  readonly least: number;
  readonly greatest: number;
  /** The level with the sharpest border there; null where all is flat. */
  suggest(at: FramePoint): number | null;
  /** Empty where there is nothing on the right side of the level. */
  outline(at: FramePoint, level: number, bridge: number): readonly FramePoint[];
  free(): void;
}

export function regionOf(image: FrameImage, dark: boolean): Region {
  const tool = new ThresholdTool(image, dark);
  return {
    least: tool.leastLevel,
    greatest: tool.greatestLevel,
    suggest: ({ column, row }) => tool.suggest(column, row) ?? null,
    outline: ({ column, row }, level, bridge) => taken(tool.outline(column, row, level, bridge, TOLERANCE), null).points,
    free: () => tool.free(),
  };
}

/** What the live-wire needs of the core; tests supply their own. */
export type WirePixels = Pick<LiveWire, 'prepare' | 'snapPoint' | 'seed' | 'expand' | 'follow' | 'common' | 'darkSide' | 'free'>;
export type CoolingPixels = Pick<Cooling, 'restart' | 'observe'>;

export function wireOf(image: FrameImage, dark: boolean): WirePixels {
  return new LiveWire(image, dark);
}

export function coolingOf(milliseconds: number): CoolingPixels {
  return new Cooling(milliseconds);
}
