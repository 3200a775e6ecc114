import type { Outline } from '../document/types';
import { simplified, smoothed, TOLERANCE, type Reshape } from './pixels';

/** How far an outline is smoothed along its length (standard deviation, px) and how far points may be left out, px. */
export interface Shaping {
  readonly smooth: number;
  readonly simplify: number;
}

/** Smoothing needs points of its own; simplifying only leaves some out. */
export function reshaped(outline: Outline, { smooth, simplify }: Shaping): Reshape {
  if (smooth > 0) return smoothed(outline, smooth, Math.max(simplify, TOLERANCE / 2));
  if (simplify > 0) return simplified(outline, simplify);
  return { points: outline.points, unknownSides: outline.unknownSides, greatest: 0, rms: 0 };
}
