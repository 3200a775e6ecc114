import { distance } from '../geometry/points';
import { canvasFromFrame, frameFromCanvas } from '../geometry/viewport';
import { edit, nextEdit, type EditState } from './edit';
import { CLOSING_REACH, FEWEST_POINTS, hitTest, reachOf } from './hit';
import { outcome, type Effect, type Input, type Machine, type Outcome, type Situation } from './machine';

/** Live-wire: the path follows the edge to the pointer, a click fixes it. On a closed outline it edits points. */
export type WireState =
  | { readonly name: 'aiming' }
  /** The button is down: the path still follows, it is fixed where the button is let go. */
  | { readonly name: 'pressed' }
  | { readonly name: 'editing'; readonly edit: EditState };

const AIMING: WireState = { name: 'aiming' };

export const wire: Machine<WireState> = { start: AIMING, next };

/** Is something under way that must not be interrupted? Aiming is not. */
export function wireBusy(state: WireState): boolean {
  return state.name === 'pressed' || (state.name === 'editing' && state.edit.name !== 'idle');
}

function next(state: WireState, input: Input, situation: Situation): Outcome<WireState> {
  if (input.type === 'cancel') return outcome(AIMING, { type: 'cancel-preview' }, { type: 'tracing', intent: { tool: 'none' } });
  if (situation.outline?.closed) return onClosed(state, input, situation);
  if (input.type === 'double') return outcome(AIMING, intent('close', input, situation));
  if (input.type === 'down') return input.button === 'primary' ? outcome({ name: 'pressed' }, intent('aim', input, situation)) : outcome(state);
  if (input.type === 'move') return outcome(state.name === 'pressed' ? state : AIMING, intent('aim', input, situation));
  if (state.name !== 'pressed') return outcome(AIMING);
  return outcome(AIMING, { type: 'select', index: null }, intent(isOnFirst(input, situation) ? 'close' : 'fix', input, situation));
}

function onClosed(state: WireState, input: Input, situation: Situation): Outcome<WireState> {
  const before = state.name === 'editing' ? state.edit : edit.start;
  const hit = hitTest(situation.outline, situation.viewport, input.at, reachOf(input));
  const edited = nextEdit(before, input, situation, hit);
  return { state: { name: 'editing', edit: edited.state }, effects: edited.effects };
}

/** Does a click here close the draft? */
export function isOnFirst(input: Pick<Input, 'at' | 'touch'>, { outline, viewport }: Pick<Situation, 'outline' | 'viewport'>): boolean {
  const first = outline?.points[0];
  if (!first || outline.points.length < FEWEST_POINTS) return false;
  return distance(canvasFromFrame(viewport, first), input.at) <= reachOf(input) * (CLOSING_REACH + 2);
}

function intent(to: 'aim' | 'fix' | 'close', input: Input, situation: Situation): Effect {
  const at = frameFromCanvas(situation.viewport, input.at);
  return { type: 'tracing', intent: { tool: 'wire', to, at, straight: input.shift === true } };
}
