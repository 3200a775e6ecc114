import { deletePoint, insertPoint, movePoint } from '../document/commands';
import { canvasPoint, distance, type CanvasPoint } from '../geometry/points';
import { canvasFromFrame, frameFromCanvas } from '../geometry/viewport';
import { hitTest, reachOf, type Hit } from './hit';
import { DRAG_THRESHOLD, outcome, type Input, type Machine, type Outcome, type Scene } from './machine';

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
  next: (state, input, scene) => nextEdit(state, input, scene, hitTest(scene.outline, scene.viewport, input.at, reachOf(input))),
};

/** The same with what lies under the pointer told by the tool. */
export function nextEdit(state: EditState, input: Input, scene: Scene, hit: Hit): Outcome<EditState> {
  if (input.type === 'cancel') return outcome(IDLE, { type: 'cancel-preview' });
  switch (state.name) {
    case 'idle':
      return input.type === 'down' && input.button === 'primary' ? press(input, scene, hit) : outcome(state);
    case 'pressed':
      return whilePressed(state, input, scene);
    case 'moving':
      return whileMoving(state, input, scene);
    case 'inserting':
      return whileInserting(state, input, scene);
  }
}

function press(input: Input, scene: Scene, hit: Hit): Outcome<EditState> {
  switch (hit.kind) {
    case 'vertex':
      if (input.alt) {
        const command = deletePoint(scene.place, hit.index);
        return outcome(IDLE, { type: 'perform', command }, { type: 'select', index: null });
      }
      return outcome({ name: 'pressed', index: hit.index, at: input.at }, { type: 'select', index: hit.index });
    case 'edge':
      return outcome(
        { name: 'inserting', index: hit.before },
        { type: 'preview', command: insertPoint(scene.place, hit.before, hit.at) },
        { type: 'select', index: hit.before },
      );
    case 'nothing':
      return outcome(IDLE, { type: 'select', index: null });
  }
}

function whilePressed(
  state: Extract<EditState, { name: 'pressed' }>,
  input: Input,
  scene: Scene,
): Outcome<EditState> {
  if (input.type === 'up') return outcome(IDLE);
  const vertex = scene.outline?.points[state.index];
  if (input.type !== 'move' || !vertex || distance(state.at, input.at) < DRAG_THRESHOLD) return outcome(state);
  const shown = canvasFromFrame(scene.viewport, vertex);
  const grip = canvasPoint(shown.x - state.at.x, shown.y - state.at.y);
  return whileMoving({ name: 'moving', index: state.index, grip }, input, scene);
}

function whileMoving(state: Extract<EditState, { name: 'moving' }>, input: Input, scene: Scene): Outcome<EditState> {
  const at = canvasPoint(input.at.x + state.grip.x, input.at.y + state.grip.y);
  const command = movePoint(scene.place, state.index, frameFromCanvas(scene.viewport, at));
  if (input.type === 'up') return outcome(IDLE, { type: 'commit', command });
  return input.type === 'move' ? outcome(state, { type: 'preview', command }) : outcome(state);
}

function whileInserting(
  state: Extract<EditState, { name: 'inserting' }>,
  input: Input,
  scene: Scene,
): Outcome<EditState> {
  const command = insertPoint(scene.place, state.index, frameFromCanvas(scene.viewport, input.at));
  if (input.type === 'up') return outcome(IDLE, { type: 'commit', command });
  return input.type === 'move' ? outcome(state, { type: 'preview', command }) : outcome(state);
}
