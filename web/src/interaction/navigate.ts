import { setWindow } from '../document/commands';
import type { GreyWindow } from '../document/types';
import { canvasPoint, type CanvasPoint } from '../geometry/points';
import { pan, zoomAt, type Viewport } from '../geometry/viewport';
import { outcome, type Effect, type Input, type Machine, type Outcome, type Situation } from './machine';

/** Panning and window/level by dragging, whatever the tool; and as tools of their own. */
export type DragState =
  | { readonly name: 'idle' }
  | { readonly name: 'panning'; readonly last: CanvasPoint }
  | { readonly name: 'windowing'; readonly from: CanvasPoint; readonly window: GreyWindow };

const IDLE: DragState = { name: 'idle' };

export const hand: Machine<DragState> = { start: IDLE, next: (state, input, situation) => drag(state, input, situation, 'panning') };

export const windowing: Machine<DragState> = {
  start: IDLE,
  next: (state, input, situation) => drag(state, input, situation, 'windowing'),
};

/** What a press begins by itself, before the tool is asked: the middle button pans, the right one windows. */
export function gestureOf(input: Input, spaceHeld: boolean): 'panning' | 'windowing' | null {
  if (input.type !== 'down') return null;
  if (input.button === 'middle' || (spaceHeld && input.button === 'primary')) return 'panning';
  return input.button === 'secondary' ? 'windowing' : null;
}

export function drag(
  state: DragState,
  input: Input,
  situation: Situation,
  kind: 'panning' | 'windowing',
): Outcome<DragState> {
  if (input.type === 'cancel') return outcome(IDLE, { type: 'cancel-preview' });
  if (state.name === 'idle') {
    if (input.type !== 'down') return outcome(state);
    return outcome(
      kind === 'panning'
        ? { name: 'panning', last: input.at }
        : { name: 'windowing', from: input.at, window: situation.window },
    );
  }
  return state.name === 'panning' ? whilePanning(state.last, input, situation) : whileWindowing(state, input);
}

function whilePanning(last: CanvasPoint, input: Input, situation: Situation): Outcome<DragState> {
  const viewport = pan(situation.viewport, input.at.x - last.x, input.at.y - last.y);
  const effect: Effect = { type: 'viewport', viewport };
  return input.type === 'up' ? outcome(IDLE, effect) : outcome({ name: 'panning', last: input.at }, effect);
}

function whileWindowing(state: Extract<DragState, { name: 'windowing' }>, input: Input): Outcome<DragState> {
  const dragged = canvasPoint(input.at.x - state.from.x, input.at.y - state.from.y);
  const moved = dragged.x !== 0 || dragged.y !== 0;
  const command = setWindow(draggedWindow(state.window, dragged));
  if (input.type === 'up') return moved ? outcome(IDLE, { type: 'commit', command }) : outcome(IDLE);
  return moved ? outcome(state, { type: 'preview', command }) : outcome(state);
}

/** The distance in CSS pixels that doubles the width, or moves the centre by the width it began with. */
const WINDOW_TRAVEL = 300;

/** Right widens, left narrows; down brightens, up darkens: as viewers of this field do. */
export function draggedWindow(window: GreyWindow, dragged: CanvasPoint): GreyWindow {
  const width = Math.max(1, window.width * 2 ** (dragged.x / WINDOW_TRAVEL));
  const centre = window.centre - (dragged.y / WINDOW_TRAVEL) * window.width;
  return { centre: Math.round(centre), width: Math.round(width) };
}

/** One notch of a mouse wheel is about 100; trackpads send small pieces. */
export function wheelZoom(viewport: Viewport, at: CanvasPoint, deltaY: number): Viewport {
  return zoomAt(viewport, at, 2 ** (-clamp(deltaY, -240, 240) / 300));
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(high, Math.max(low, value));
}
