import { canvasPoint, framePoint } from '../geometry/points';
import { canvasFromFrame, frameFromCanvas } from '../geometry/viewport';
import type { Controller } from '../interaction/controller';
import type { Input } from '../interaction/machine';
import type { App } from '../commands/app';
import { act, situationOf } from './stage_input';
import type { StageView } from './stage_view';

/** The keyboard's way to point and press: it moves the same pointer that the mouse does. */

/** Moves the pointer by frame pixels; from the middle of the frame where it is not on it. */
export function pointByKey(
  app: App,
  view: StageView,
  controller: Controller,
  by: { readonly columns: number; readonly rows: number },
): void {
  const viewport = view.viewport(app.services.store.state);
  const { width, height } = view.size;
  const from = view.pointer ?? canvasPoint(width / 2, height / 2);
  const { column, row } = frameFromCanvas(viewport, from);
  const to = canvasFromFrame(viewport, framePoint(column + by.columns, row + by.rows));
  const kept = canvasPoint(within(to.x, width), within(to.y, height));
  send(app, view, controller, 'move', kept);
  view.setPointer(kept, 'keys');
}

/** A click; where a stretch or a stroke has to be drawn, the next press lets go. */
export function pressByKey(app: App, view: StageView, controller: Controller): void {
  const at = view.pointer;
  if (!at) return;
  const { tool } = app.services.store.ui;
  const draws = tool === 'brush' || tool === 'stretch';
  if (controller.busy) return send(app, view, controller, 'up', at);
  send(app, view, controller, 'down', at);
  if (!draws) send(app, view, controller, 'up', at);
}

function send(app: App, view: StageView, controller: Controller, type: Input['type'], at: Input['at']): void {
  const situation = situationOf(app.services.store, view);
  if (situation) act(app, controller, { type, at, button: 'primary', alt: false }, situation);
  view.schedule();
}

function within(value: number, most: number): number {
  return Math.min(most - 1, Math.max(0, value));
}
