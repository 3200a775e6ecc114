import type { HandSituation } from './hand_situation';
import type { TracingIntent } from './tracing_intent';
import type { CanvasPoint, FramePoint } from '../geometry/points';
import type { Size, Viewport } from '../geometry/viewport';
import type { Command, Place } from '../document/command';
import type { GreyWindow, Outline } from '../document/types';

/**
 * Interactions are state machines without a DOM: an input and the situation go in, the next state and effects come out.
 * Tests drive them with plain values.
 */
export type Button = 'primary' | 'middle' | 'secondary';

export interface Input {
  readonly type: 'down' | 'move' | 'up' | 'double' | 'cancel';
  readonly at: CanvasPoint;
  readonly button: Button;
  readonly alt: boolean;
  readonly shift?: boolean;
  /** A finger: it covers more than it points at. */
  readonly touch?: boolean;
  readonly ctrl?: boolean;
}

export interface Situation {
  readonly viewport: Viewport;
  readonly frame: Size;
  readonly place: Place;
  readonly outline: Outline | null;
  readonly window: GreyWindow;
  /** The brush takes away; with Alt held the other way round. */
  readonly erase: boolean;
  /** Null where no model can be adjusted: it, the calibration or the frame is missing. */
  readonly hand?: HandSituation | null;
}

export type Effect =
  | { readonly type: 'perform'; readonly command: Command }
  | { readonly type: 'preview'; readonly command: Command }
  | { readonly type: 'commit'; readonly command: Command }
  | { readonly type: 'cancel-preview' }
  | { readonly type: 'select'; readonly index: number | null }
  | { readonly type: 'viewport'; readonly viewport: Viewport }
  | { readonly type: 'mark'; readonly at: FramePoint; readonly begins: boolean }
  | { readonly type: 'tracing'; readonly intent: TracingIntent };

export interface Outcome<State> {
  readonly state: State;
  readonly effects: readonly Effect[];
}

export interface Machine<State> {
  readonly start: State;
  readonly next: (state: State, input: Input, situation: Situation) => Outcome<State>;
}

export function outcome<State>(state: State, ...effects: readonly Effect[]): Outcome<State> {
  return { state, effects };
}

/** A press that moves less than this is a click: hands tremble. */
export const DRAG_THRESHOLD = 3;
