import { distance, type CanvasPoint } from '../geometry/points';
import { frameFromCanvas } from '../geometry/viewport';
import { DRAG_THRESHOLD, outcome, type Input, type Machine, type Outcome, type Situation } from './machine';

/** A click inside the implant, or a rough box around it. */
export type OneClickState =
  | { readonly name: 'idle' }
  | { readonly name: 'pressed'; readonly from: CanvasPoint }
  | { readonly name: 'boxing'; readonly from: CanvasPoint };

const IDLE: OneClickState = { name: 'idle' };

export const oneClick: Machine<OneClickState> = { start: IDLE, next };

function next(state: OneClickState, input: Input, situation: Situation): Outcome<OneClickState> {
  if (input.type === 'cancel') return outcome(IDLE, { type: 'tracing', intent: { tool: 'none' } });
  if (state.name === 'idle') {
    const begins = input.type === 'down' && input.button === 'primary';
    return outcome(begins ? { name: 'pressed', from: input.at } : state);
  }
  const at = frameFromCanvas(situation.viewport, input.at);
  const from = frameFromCanvas(situation.viewport, state.from);
  if (state.name === 'pressed' && distance(state.from, input.at) < DRAG_THRESHOLD) {
    if (input.type !== 'up') return outcome(state);
    return outcome(IDLE, { type: 'tracing', intent: { tool: 'one-click', to: 'point', at: from } });
  }
  if (input.type === 'up') return outcome(IDLE, { type: 'tracing', intent: { tool: 'one-click', to: 'box', from, at } });
  if (input.type !== 'move') return outcome(state);
  return outcome({ name: 'boxing', from: state.from }, { type: 'tracing', intent: { tool: 'one-click', to: 'frame', from, at } });
}
