import { framePoint } from '../geometry/points';
import { frameFromCanvas } from '../geometry/viewport';
import { outcome, type Input, type Machine, type Outcome, type Situation } from './machine';

/** Marking a ruler: a press sets a mark, which can be dragged into place until the button is let go. */
export type RulerState = { readonly name: 'idle' } | { readonly name: 'placing' };

const IDLE: RulerState = { name: 'idle' };

export const ruler: Machine<RulerState> = { start: IDLE, next };

function next(state: RulerState, input: Input, situation: Situation): Outcome<RulerState> {
  if (input.type === 'cancel' || input.type === 'double') return outcome(IDLE);
  const begins = state.name === 'idle' && input.type === 'down' && input.button === 'primary';
  if (!begins && state.name === 'idle') return outcome(state);
  const { column, row } = frameFromCanvas(situation.viewport, input.at);
  const { width, height } = situation.frame;
  const at = framePoint(Math.min(width, Math.max(0, column)), Math.min(height, Math.max(0, row)));
  return outcome(input.type === 'up' ? IDLE : { name: 'placing' }, { type: 'mark', at, begins });
}
