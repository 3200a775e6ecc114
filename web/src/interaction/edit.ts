import { deletePoint, insertPoint, movePoint } from '../document/commands';
import { canvasPoint, distance, type CanvasPoint } from '../geometry/points';
import { canvasFromFrame, frameFromCanvas } from '../geometry/viewport';
import { hitTest, reachOf, type Hit } from './hit';
import { DRAG_THRESHOLD, outcome, type Input, type Machine, type Outcome, type Situation } from './machine';

/** Moving, inserting and deleting the points of an outline. */
export type EditState =
  | { readonly name: 'idle' }
  /** The button is down on a vertex and has not moved. */
  | { readonly name: 'pressed'; readonly index: number; readonly at: CanvasPoint }
  /** `grip`: from the pointer to the vertex, so that it does not jump to the pointer. */
  | { readonly name: 'moving'; readonly index: number; readonly grip: CanvasPoint }
  | { readonly name: 'inserting'; readonly index: number };

const IDLE: EditState = { name: 'idle' };

export const edit: Machine<EditState> = {
  start: IDLE,
  next: (state, input, situation) => nextEdit(state, input, situation, hitTest(situation.outline, situation.viewport, input.at, reachOf(input))),
};

/** The same with what lies under the pointer told by the tool. */
export function nextEdit(state: EditState, input: Input, situation: Situation, hit: Hit): Outcome<EditState> {
  if (input.type === 'cancel') return outcome(IDLE, { type: 'cancel-preview' });
  switch (state.name) {
    case 'idle':
      return input.type === 'down' && input.button === 'primary' ? press(input, situation, hit) : outcome(state);
    case 'pressed':
      return whilePressed(state, input, situation);
    case 'moving':
      return whileMoving(state, input, situation);
    case 'inserting':
      return whileInserting(state, input, situation);
  }
}

function press(input: Input, situation: Situation, hit: Hit): Outcome<EditState> {
  switch (hit.kind) {
    case 'vertex':
      if (input.alt) {
        const command = deletePoint(situation.place, hit.index);
        return outcome(IDLE, { type: 'perform', command }, { type: 'select', index: null });
      }
      return outcome({ name: 'pressed', index: hit.index, at: input.at }, { type: 'select', index: hit.index });
    case 'edge':
      return outcome(
        { name: 'inserting', index: hit.before },
        { type: 'preview', command: insertPoint(situation.place, hit.before, hit.at) },
        { type: 'select', index: hit.before },
      );
    case 'nothing':
      return outcome(IDLE, { type: 'select', index: null });
  }
}

function whilePressed(
  state: Extract<EditState, { name: 'pressed' }>,
  input: Input,
  situation: Situation,
): Outcome<EditState> {
  if (input.type === 'up') return outcome(IDLE);
  const vertex = situation.outline?.points[state.index];
  if (input.type !== 'move' || !vertex || distance(state.at, input.at) < DRAG_THRESHOLD) return outcome(state);
  const shown = canvasFromFrame(situation.viewport, vertex);
  const grip = canvasPoint(shown.x - state.at.x, shown.y - state.at.y);
  return whileMoving({ name: 'moving', index: state.index, grip }, input, situation);
}

function whileMoving(state: Extract<EditState, { name: 'moving' }>, input: Input, situation: Situation): Outcome<EditState> {
  const at = canvasPoint(input.at.x + state.grip.x, input.at.y + state.grip.y);
  const command = movePoint(situation.place, state.index, frameFromCanvas(situation.viewport, at));
  if (input.type === 'up') return outcome(IDLE, { type: 'commit', command });
  return input.type === 'move' ? outcome(state, { type: 'preview', command }) : outcome(state);
}

function whileInserting(
  state: Extract<EditState, { name: 'inserting' }>,
  input: Input,
  situation: Situation,
): Outcome<EditState> {
  const command = insertPoint(situation.place, state.index, frameFromCanvas(situation.viewport, input.at));
  if (input.type === 'up') return outcome(IDLE, { type: 'commit', command });
  return input.type === 'move' ? outcome(state, { type: 'preview', command }) : outcome(state);
}
