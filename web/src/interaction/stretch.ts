import { toggleUnknownSide } from '../document/commands';
import { markStretch } from '../document/outlines';
import { ahead, lengthsAlong, type Stretch } from '../document/stretch';
import type { Outline } from '../document/types';
import { distance, nearestOnSegment, type CanvasPoint } from '../geometry/points';
import { canvasFromFrame, type Viewport } from '../geometry/viewport';
import { reachOf } from './hit';
import { DRAG_THRESHOLD, outcome, type Input, type Machine, type Outcome, type Situation } from './machine';

/** Marking a stretch of a closed outline as unknown by dragging along it; as known again where it began on unknown. */
export type StretchState =
  | { readonly name: 'idle' }
  | {
      readonly name: 'dragging';
      readonly from: CanvasPoint;
      readonly last: CanvasPoint;
      readonly stretch: Stretch;
      /** The side that was pressed: a click toggles it. */
      readonly side: number;
      readonly unknown: boolean;
      readonly meant: boolean;
    };

const IDLE: StretchState = { name: 'idle' };

/** From this near a press takes hold of the outline, CSS px. */
export const STRETCH_REACH = 16;
/** The hold may slide this much further than the hand moved: corners are cut. */
const SLIDE = 3;
const SLACK = 24;

export const stretch: Machine<StretchState> = { start: IDLE, next };

function next(state: StretchState, input: Input, situation: Situation): Outcome<StretchState> {
  if (input.type === 'cancel') return outcome(IDLE, { type: 'cancel-preview' });
  const { outline } = situation;
  if (!outline?.closed) return outcome(IDLE);
  if (state.name === 'dragging') return whileDragging(state, input, situation, outline);
  if (input.type !== 'down' || input.button !== 'primary') return outcome(state);
  const hold = holdOf(outline, situation.viewport, input.at);
  if (!hold || hold.away > reachOf(input) * STRETCH_REACH) return outcome(state);
  return outcome({
    name: 'dragging',
    from: input.at,
    last: input.at,
    stretch: { start: hold.along, extent: 0 },
    side: hold.side,
    unknown: !outline.unknownSides.includes(hold.side),
    meant: false,
  });
}

function whileDragging(
  state: Extract<StretchState, { name: 'dragging' }>,
  input: Input,
  situation: Situation,
  shown: Outline,
): Outcome<StretchState> {
  const meant = state.meant || distance(state.from, input.at) >= DRAG_THRESHOLD;
  if (!meant) {
    if (input.type !== 'up') return outcome(state);
    return outcome(IDLE, { type: 'perform', command: toggleUnknownSide(situation.place, state.side) });
  }
  const followed = follow(state, input.at, shown, situation.viewport);
  const command = markStretch(situation.place, followed, state.unknown);
  if (input.type === 'up') return outcome(IDLE, { type: 'commit', command });
  if (input.type !== 'move') return outcome(state);
  return outcome({ ...state, meant, last: input.at, stretch: followed }, { type: 'preview', command });
}

/**
 * The stretch when the hand has gone on. It slides along the outline and never jumps to another part of it that
 * happens to be nearer: the outline of a thin part has two sides.
 */
function follow(
  { stretch: { start, extent }, last }: Extract<StretchState, { name: 'dragging' }>,
  at: CanvasPoint,
  outline: Outline,
  viewport: Viewport,
): Stretch {
  const length = lengthsAlong(outline.points).at(-1) ?? 0;
  const reach = (SLIDE * distance(last, at) + SLACK) / viewport.scale;
  const hold = holdOf(outline, viewport, at, { around: start + extent, reach, length });
  const slid = hold ? ahead(start + extent, hold.along, length) : 0;
  return { start, extent: Math.max(-length, Math.min(length, extent + slid)) };
}

interface Hold {
  readonly side: number;
  /** Frame pixels along the outline from point 0. */
  readonly along: number;
  /** CSS pixels. */
  readonly away: number;
}

/** The nearest place on the outline; with `near`, only within a reach along it. */
export function holdOf(
  outline: Outline,
  viewport: Viewport,
  at: CanvasPoint,
  near?: { readonly around: number; readonly reach: number; readonly length: number },
): Hold | null {
  const points = outline.points.map((point) => canvasFromFrame(viewport, point));
  const lengths = lengthsAlong(outline.points);
  let best: Hold | null = null;
  points.forEach((from, side) => {
    const on = nearestOnSegment(at, from, points[(side + 1) % points.length]!);
    const away = distance(on, at);
    const along = (lengths[side] ?? 0) + distance(from, on) / viewport.scale;
    if (best && best.away <= away) return;
    if (near && Math.abs(ahead(near.around, along, near.length)) > near.reach) return;
    best = { side, along, away };
  });
  return best;
}
