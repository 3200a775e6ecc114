import type { CanvasPoint } from '../geometry/points';
import { frameFromCanvas } from '../geometry/viewport';
import { DRAG_THRESHOLD, outcome, type Input, type Machine, type Outcome, type Situation } from './machine';

/** Pointing shows a region, a press takes it; dragging up and down from there changes the level until it is let go. */
export type ThresholdState =
  | { readonly name: 'idle' }
  | { readonly name: 'pressed'; readonly from: CanvasPoint; readonly meant: boolean };

const IDLE: ThresholdState = { name: 'idle' };

export const threshold: Machine<ThresholdState> = { start: IDLE, next };

function next(state: ThresholdState, input: Input, situation: Situation): Outcome<ThresholdState> {
  if (input.type === 'cancel') return outcome(IDLE, { type: 'tracing', intent: { tool: 'none' } });
  const at = frameFromCanvas(situation.viewport, input.at);
  if (state.name === 'idle') {
    if (input.type === 'move') return outcome(state, { type: 'tracing', intent: { tool: 'threshold', to: 'aim', at } });
    if (input.type !== 'down' || input.button !== 'primary') return outcome(state);
    const pressed: ThresholdState = { name: 'pressed', from: input.at, meant: false };
    return outcome(pressed, { type: 'select', index: null }, { type: 'tracing', intent: { tool: 'threshold', to: 'take', at } });
  }
  if (input.type === 'up') return outcome(IDLE, { type: 'tracing', intent: { tool: 'threshold', to: 'let-go' } });
  const down = input.at.y - state.from.y;
  const meant = state.meant || Math.abs(down) >= DRAG_THRESHOLD;
  if (input.type !== 'move' || !meant) return outcome(state);
  return outcome({ ...state, meant }, { type: 'tracing', intent: { tool: 'threshold', to: 'drag', down } });
}
