import type { FramePoint } from '../geometry/points';
import { frameFromCanvas } from '../geometry/viewport';
import { outcome, type Input, type Machine, type Outcome, type Situation } from './machine';

/** Painting: what the disc touches is added to the outline or taken from it. */
export type BrushState =
  | { readonly name: 'idle' }
  | { readonly name: 'painting'; readonly stroke: readonly FramePoint[]; readonly erase: boolean };

const IDLE: BrushState = { name: 'idle' };

export const brush: Machine<BrushState> = { start: IDLE, next };

function next(state: BrushState, input: Input, situation: Situation): Outcome<BrushState> {
  if (input.type === 'cancel') return outcome(IDLE, { type: 'cancel-preview' }, { type: 'tracing', intent: { tool: 'none' } });
  const at = frameFromCanvas(situation.viewport, input.at);
  if (state.name === 'idle') {
    if (input.type !== 'down' || input.button !== 'primary') return outcome(state);
    return painting([at], situation.erase !== input.alt, 'paint');
  }
  const stroke = [...state.stroke, at];
  if (input.type === 'up') return painting(stroke, state.erase, 'finish');
  return input.type === 'move' ? painting(stroke, state.erase, 'paint') : outcome(state);
}

function painting(stroke: readonly FramePoint[], erase: boolean, to: 'paint' | 'finish'): Outcome<BrushState> {
  const state: BrushState = to === 'finish' ? IDLE : { name: 'painting', stroke, erase };
  return outcome(state, { type: 'tracing', intent: { tool: 'brush', to, stroke, erase } });
}
