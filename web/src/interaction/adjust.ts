import type { HandSituation } from './hand_situation';
import { setPoseByHand } from '../document/hand_poses';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { canvasPoint, distance, framePoint, type CanvasPoint } from '../geometry/points';
import { inCamera, movedInDepth, projected, shifted, rotated } from '../geometry/pose_motion';
import { canvasFromFrame, type Viewport } from '../geometry/viewport';
import { DRAG_THRESHOLD, outcome, type Input, type Machine, type Outcome, type Situation } from './machine';
import { texts } from '../texts/texts';

/** In the image plane, around the line of sight, around lines across it, along it. */
export type Motion = 'move' | 'turn' | 'tilt' | 'depth';

export type AdjustState =
  | { readonly name: 'idle' }
  | { readonly name: 'dragging'; readonly motion: Motion; readonly last: CanvasPoint; readonly pose: PoseNumbers; readonly moved: boolean };

const IDLE: AdjustState = { name: 'idle' };

/** Dragging a model: in the plane, or by its handles or with keys held around its axes. */
export const adjust: Machine<AdjustState> = { start: IDLE, next };

function next(state: AdjustState, input: Input, situation: Situation): Outcome<AdjustState> {
  if (input.type === 'cancel') return outcome(IDLE, { type: 'cancel-preview' });
  const { hand } = situation;
  if (!hand) return outcome(IDLE);
  return state.name === 'idle' ? press(input, situation, hand) : whileDragging(state, input, situation, hand);
}

function press(input: Input, situation: Situation, hand: HandSituation): Outcome<AdjustState> {
  if (input.type !== 'down' || input.button !== 'primary') return outcome(IDLE);
  const motion = heldMotion(input) ?? handleAt(hand, situation.viewport, input.at) ?? 'move';
  const state = { name: 'dragging', motion, last: input.at, pose: hand.pose, moved: false } as const;
  if (!hand.absent) return outcome(state);
  return outcome({ ...state, moved: true }, { type: 'preview', command: setPoseByHand(situation.place, hand.pose, texts.steps.placeModel) });
}

/** Keys held with the mouse: Shift tilts, Ctrl turns in the plane, both move along the view. */
function heldMotion({ ctrl, shift }: Input): Motion | null {
  if (ctrl && shift) return 'depth';
  if (shift) return 'tilt';
  return ctrl ? 'turn' : null;
}

function whileDragging(
  state: Extract<AdjustState, { name: 'dragging' }>,
  input: Input,
  situation: Situation,
  hand: HandSituation,
): Outcome<AdjustState> {
  if (input.type === 'up' && !state.moved) return outcome(IDLE);
  if (!state.moved && distance(state.last, input.at) < DRAG_THRESHOLD) return outcome(state);
  const pose = dragged(state, input.at, situation.viewport, hand);
  const command = setPoseByHand(situation.place, pose, LABELS[state.motion]);
  if (input.type === 'up') return outcome(IDLE, { type: 'commit', command });
  if (input.type !== 'move') return outcome(state);
  return outcome({ ...state, last: input.at, pose, moved: true }, { type: 'preview', command });
}

const LABELS: Readonly<Record<Motion, string>> = {
  move: texts.steps.moveModel,
  turn: texts.steps.turnModel,
  tilt: texts.steps.tiltModel,
  depth: texts.steps.modelAlongView,
};

/** A model tilts by this much a CSS pixel, degrees, and moves along the view by this fraction of its depth. */
const TILT = 0.25;
const DEPTH = 0.001;
/** The mouse in fine steps, as a fraction of the usual. */
const FINE = 0.2;

/** The pose after the pointer went from the last place to `to`. */
function dragged(
  { motion, last, pose }: { motion: Motion; last: CanvasPoint; pose: PoseNumbers },
  to: CanvasPoint,
  viewport: Viewport,
  { middle, camera, locks, fine }: HandSituation,
): PoseNumbers {
  const fraction = fine ? FINE : 1;
  const [right, down] = [(to.x - last.x) * fraction, (to.y - last.y) * fraction];
  const depth = -inCamera(pose, middle)[2];
  switch (motion) {
    case 'move': {
      const perPixel = depth / viewport.scale;
      return shifted(pose, (right * perPixel) / camera.fx, (-down * perPixel) / camera.fy, locks);
    }
    case 'tilt':
      return rotated(pose, [down * TILT, right * TILT, 0], middle, locks);
    case 'turn': {
      const centre = centreOf({ pose, middle, camera }, viewport);
      return centre ? rotated(pose, [0, 0, fraction * angleBetween(centre, last, to)], middle, locks) : pose;
    }
    case 'depth':
      return movedInDepth(pose, down * DEPTH * depth, middle, locks);
  }
}

/** Degrees from one place to another round a centre, positive against the clock. */
function angleBetween(centre: CanvasPoint, from: CanvasPoint, to: CanvasPoint): number {
  const angle = (at: CanvasPoint) => Math.atan2(centre.y - at.y, at.x - centre.x);
  const turn = ((angle(to) - angle(from)) * 180) / Math.PI;
  return turn - 360 * Math.round(turn / 360);
}

// --- Handles: what a finger or a pen can take hold of --------------------------------------------------------------------

/** CSS pixels: the ring around the middle of the model, and how near a press must be. */
export const RING = 64;
const KNOB_REACH = 14;
const RING_REACH = 7;

/** Where the middle of the model is on the canvas. */
export function centreOf({ pose, middle, camera }: Pick<HandSituation, 'pose' | 'middle' | 'camera'>, viewport: Viewport): CanvasPoint | null {
  const at = projected(camera, inCamera(pose, middle));
  return at && canvasFromFrame(viewport, framePoint(at.column, at.row));
}

/** Places of the knobs: turning at the right of the ring, depth below, tilting in the middle. */
export function knobs(centre: CanvasPoint): Readonly<Record<Exclude<Motion, 'move'>, CanvasPoint>> {
  return {
    turn: canvasPoint(centre.x + RING, centre.y),
    depth: canvasPoint(centre.x, centre.y + RING),
    tilt: centre,
  };
}

/** Which handle lies under the pointer. */
export function handleAt(hand: HandSituation, viewport: Viewport, at: CanvasPoint): Motion | null {
  const centre = hand.absent ? null : centreOf(hand, viewport);
  if (!centre) return null;
  const places = Object.entries(knobs(centre)) as [Motion, CanvasPoint][];
  const knob = places.find(([, place]) => distance(place, at) <= KNOB_REACH);
  if (knob) return knob[0];
  return Math.abs(distance(centre, at) - RING) <= RING_REACH ? 'turn' : null;
}
