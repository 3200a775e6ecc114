import { transformOutline } from '../document/outlines';
import { canvasPoint, distance, framePoint, type CanvasPoint, type FramePoint } from '../geometry/points';
import { boundsOf, middleOf, moved, scaled, rotated, type Bounds, type Similarity } from '../geometry/similarity';
import { canvasFromFrame, frameFromCanvas, type Viewport } from '../geometry/viewport';
import { reachOf } from './hit';
import { DRAG_THRESHOLD, outcome, type Input, type Machine, type Outcome, type Situation } from './machine';
import { texts } from '../texts/texts';

/** Moving, turning and scaling a whole outline by the box of handles around it. */
export const CORNERS = ['top-left', 'top-right', 'bottom-right', 'bottom-left'] as const;
export type Corner = (typeof CORNERS)[number];
export type Handle = Corner | 'turn' | 'inside';

export type TransformState =
  | { readonly name: 'idle' }
  /** `bounds` are those of the outline before the gesture: every step starts from there. */
  | {
      readonly name: 'dragging';
      readonly handle: Handle;
      readonly from: CanvasPoint;
      readonly bounds: Bounds;
      /** The hand has moved far enough to mean it. */
      readonly meant: boolean;
    };

const IDLE: TransformState = { name: 'idle' };

/** A finger's width is more, but corners of a small outline must not cover its inside. */
export const HANDLE_REACH = 11;
/** The handle that turns stands this far above the box, CSS px. */
const STALK = 28;

export const transform: Machine<TransformState> = { start: IDLE, next };

function next(state: TransformState, input: Input, situation: Situation): Outcome<TransformState> {
  if (input.type === 'cancel') return outcome(IDLE, { type: 'cancel-preview' });
  if (state.name === 'dragging') return whileDragging(state, input, situation);
  const bounds = boundsOf(situation.outline?.points ?? []);
  if (!bounds || input.type !== 'down' || input.button !== 'primary') return outcome(state);
  const handle = handleAt(bounds, situation.viewport, input.at, reachOf(input));
  return outcome(handle ? { name: 'dragging', handle, from: input.at, bounds, meant: false } : state);
}

function whileDragging(
  state: Extract<TransformState, { name: 'dragging' }>,
  input: Input,
  situation: Situation,
): Outcome<TransformState> {
  const meant = state.meant || distance(state.from, input.at) >= DRAG_THRESHOLD;
  if (!meant) return outcome(input.type === 'up' ? IDLE : state);
  const similarity = similarityOf(state, input, situation.viewport);
  const command = transformOutline(situation.place, LABELS[kindOf(state.handle)], similarity);
  if (input.type === 'up') return outcome(IDLE, { type: 'commit', command });
  return input.type === 'move' ? outcome({ ...state, meant }, { type: 'preview', command }) : outcome(state);
}

const LABELS = { move: texts.steps.moveOutline, turn: texts.steps.turnOutline, scale: texts.steps.scaleOutline } as const;

function kindOf(handle: Handle): keyof typeof LABELS {
  if (handle === 'inside') return 'move';
  return handle === 'turn' ? 'turn' : 'scale';
}

/** What a drag from one place to another does to an outline within `bounds`. With Alt it scales about the middle. */
function similarityOf(
  { handle, from, bounds }: Extract<TransformState, { name: 'dragging' }>,
  { at, alt }: Input,
  viewport: Viewport,
): Similarity {
  const [start, end] = [frameFromCanvas(viewport, from), frameFromCanvas(viewport, at)];
  if (handle === 'inside') return moved(end.column - start.column, end.row - start.row);
  const middle = middleOf(bounds);
  if (handle === 'turn') return rotated(middle, directionOf(middle, end) - directionOf(middle, start));
  const pivot = alt ? middle : cornerOf(bounds, opposite(handle));
  const factor = away(pivot, end) / Math.max(away(pivot, start), 1e-6);
  return scaled(pivot, Math.min(MOST_SCALED, Math.max(1 / MOST_SCALED, factor)));
}

/** Nobody means more in one drag, and an outline must not vanish in its own corner. */
const MOST_SCALED = 10;

/** What lies under the pointer, the small things first. */
export function handleAt(bounds: Bounds, viewport: Viewport, at: CanvasPoint, wide = 1): Handle | null {
  if (distance(turnHandle(bounds, viewport), at) <= wide * HANDLE_REACH) return 'turn';
  const corner = CORNERS.find((name) => distance(canvasFromFrame(viewport, cornerOf(bounds, name)), at) <= wide * HANDLE_REACH);
  if (corner) return corner;
  const { column, row } = frameFromCanvas(viewport, at);
  const inside = column >= bounds.left && column <= bounds.right && row >= bounds.top && row <= bounds.bottom;
  return inside ? 'inside' : null;
}

export function turnHandle(bounds: Bounds, viewport: Viewport): CanvasPoint {
  const top = canvasFromFrame(viewport, framePoint((bounds.left + bounds.right) / 2, bounds.top));
  return canvasPoint(top.x, top.y - STALK);
}

export function cornerOf({ left, top, right, bottom }: Bounds, corner: Corner): FramePoint {
  return framePoint(corner.endsWith('left') ? left : right, corner.startsWith('top') ? top : bottom);
}

function opposite(corner: Corner): Corner {
  return CORNERS[(CORNERS.indexOf(corner) + 2) % CORNERS.length]!;
}

function directionOf(from: FramePoint, to: FramePoint): number {
  return Math.atan2(to.row - from.row, to.column - from.column);
}

function away(from: FramePoint, to: FramePoint): number {
  return Math.hypot(to.column - from.column, to.row - from.row);
}
