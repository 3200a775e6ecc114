import { distance, nearestOnSegment, type CanvasPoint, type FramePoint } from '../geometry/points';
import { canvasFromFrame, frameFromCanvas, type Viewport } from '../geometry/viewport';
import type { Outline } from '../document/types';
import type { Input } from './machine';

/** What of an outline lies under the pointer. */
export type Hit =
  | { readonly kind: 'vertex'; readonly index: number }
  /** Between point `before - 1` and the next; `at` lies on the edge. */
  | { readonly kind: 'edge'; readonly before: number; readonly at: FramePoint }
  | { readonly kind: 'nothing' };

/** Wide enough to hit with a mouse on a bad day. */
export const VERTEX_REACH = 9;
export const EDGE_REACH = 6;
/** The point that closes a draft: as large as it is drawn. */
export const CLOSING_REACH = 7;
/** While a draft grows its other points can be dragged from this near ... */
export const DRAFT_REACH = 3;
/** ... but a click beside one sets another: points are often set close together. */
export const SAME_SPOT = 1.5;

const NOTHING: Hit = { kind: 'nothing' };

/** `wide`: how many times as far as a mouse the pointer reaches. */
export function hitTest(outline: Outline | null, viewport: Viewport, at: CanvasPoint, wide = 1): Hit {
  if (!outline || outline.points.length === 0) return NOTHING;
  const points = outline.points.map((point) => canvasFromFrame(viewport, point));
  return hitVertex(points, at, () => wide * VERTEX_REACH) ?? hitEdge(points, outline.closed, viewport, at, wide) ?? NOTHING;
}

/** While tracing: only the point that closes the draft is easy to hit; no edges. */
export function hitDraft(outline: Outline | null, viewport: Viewport, at: CanvasPoint, wide = 1): Hit {
  const points = (outline?.points ?? []).map((point) => canvasFromFrame(viewport, point));
  const closes = points.length >= FEWEST_POINTS;
  return hitVertex(points, at, (index) => (index === 0 && closes ? wide * CLOSING_REACH : DRAFT_REACH)) ?? NOTHING;
}

/** A finger reaches twice as far. */
export function reachOf({ touch }: Pick<Input, 'touch'>): number {
  return touch ? 2 : 1;
}

/** An outline with fewer points encloses nothing. */
export const FEWEST_POINTS = 3;

type Reach = (index: number) => number;

function hitVertex(points: readonly CanvasPoint[], at: CanvasPoint, reach: Reach): Hit | null {
  let best: { index: number; away: number } | null = null;
  points.forEach((point, index) => {
    const away = distance(point, at);
    if (away <= reach(index) && (best === null || away < best.away)) best = { index, away };
  });
  const found = best as { index: number } | null;
  return found && { kind: 'vertex', index: found.index };
}

/** Which side is meant by what is under the pointer and the selected point; null where nothing is meant. */
export function sideMeant(hit: Hit, selectedPoint: number | null, points: number): number | null {
  if (hit.kind === 'edge') return (hit.before - 1) % points;
  if (selectedPoint !== null) return selectedPoint;
  return hit.kind === 'vertex' ? hit.index : null;
}

function hitEdge(points: readonly CanvasPoint[], closed: boolean, viewport: Viewport, at: CanvasPoint, wide: number): Hit | null {
  const edges = closed ? points.length : points.length - 1;
  let best: { before: number; on: CanvasPoint; away: number } | null = null;
  for (let start = 0; start < edges; start++) {
    const on = nearestOnSegment(at, points[start]!, points[(start + 1) % points.length]!);
    const away = distance(on, at);
    if (away <= wide * EDGE_REACH && (best === null || away < best.away)) best = { before: start + 1, on, away };
  }
  return best && { kind: 'edge', before: best.before, at: frameFromCanvas(viewport, best.on) };
}
