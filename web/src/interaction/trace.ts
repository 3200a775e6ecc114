import { addPoint, closeOutline } from '../document/commands';
import { distance } from '../geometry/points';
import { canvasFromFrame, frameFromCanvas } from '../geometry/viewport';
import { edit, nextEdit, type EditState } from './edit';
import { FEWEST_POINTS, hitDraft, hitTest, reachOf, SAME_SPOT } from './hit';
import { outcome, type Input, type Machine, type Outcome, type Situation } from './machine';

/**
 * Tracing by clicks. A press on a point of the draft, or anywhere once the outline is closed, edits; a press elsewhere
 * adds a point that can be dragged into place until the button is let go.
 */
export type TraceState =
  | { readonly name: 'editing'; readonly edit: EditState; readonly maybeClosing: boolean }
  | { readonly name: 'adding' };

const IDLE: TraceState = { name: 'editing', edit: edit.start, maybeClosing: false };

export const trace: Machine<TraceState> = { start: IDLE, next };

function next(state: TraceState, input: Input, situation: Situation): Outcome<TraceState> {
  if (input.type === 'cancel') return outcome(IDLE, { type: 'cancel-preview' });
  if (input.type === 'double' && isDraft(situation)) return outcome(IDLE, ...close(situation));
  return state.name === 'adding' ? whileAdding(input, situation) : whileEditing(state, input, situation);
}

function whileEditing(
  state: Extract<TraceState, { name: 'editing' }>,
  input: Input,
  situation: Situation,
): Outcome<TraceState> {
  const find = isDraft(situation) ? hitDraft : hitTest;
  const hit = find(situation.outline, situation.viewport, input.at, reachOf(input));
  const fresh = input.type === 'down' && input.button === 'primary' && state.edit.name === 'idle';
  if (fresh && isDraft(situation) && hit.kind !== 'vertex') return whileAdding(input, situation);
  if (input.type === 'up' && state.maybeClosing && state.edit.name === 'pressed') {
    return outcome(IDLE, ...close(situation));
  }
  if (input.type === 'up' && isDraft(situation) && isBeside(state.edit, input, situation)) {
    const command = addPoint(situation.place, frameFromCanvas(situation.viewport, input.at));
    return outcome(IDLE, { type: 'perform', command }, { type: 'select', index: null });
  }
  const edited = nextEdit(state.edit, input, situation, hit);
  const canClose = isDraft(situation) && (situation.outline?.points.length ?? 0) >= FEWEST_POINTS;
  const onFirst = hit.kind === 'vertex' && hit.index === 0 && canClose && !input.alt;
  const maybeClosing = fresh ? onFirst : state.maybeClosing;
  return { state: { name: 'editing', edit: edited.state, maybeClosing }, effects: edited.effects };
}

function whileAdding(input: Input, situation: Situation): Outcome<TraceState> {
  const command = addPoint(situation.place, frameFromCanvas(situation.viewport, input.at));
  if (input.type === 'up') return outcome(IDLE, { type: 'commit', command });
  return outcome({ name: 'adding' }, { type: 'preview', command });
}

/** A click near a point of the draft, but not on it. */
function isBeside(pressed: EditState, input: Input, situation: Situation): boolean {
  const vertex = pressed.name === 'pressed' ? situation.outline?.points[pressed.index] : undefined;
  return vertex !== undefined && distance(canvasFromFrame(situation.viewport, vertex), input.at) > SAME_SPOT;
}

/** Too few points to close: nothing happens, the status line says why. */
function close(situation: Situation) {
  if (!situation.outline || situation.outline.points.length < FEWEST_POINTS) return [];
  const select = { type: 'select', index: null } as const;
  return [{ type: 'perform', command: closeOutline(situation.place) } as const, select];
}

function isDraft(situation: Situation): boolean {
  return situation.outline?.closed !== true;
}
