import { currentCell, currentFrame, currentPlace, type Store } from '../document/store';
import { canvasPoint } from '../geometry/points';
import type { Controller } from '../interaction/controller';
import type { Effect, Input, Situation } from '../interaction/machine';
import type { App } from '../commands/app';
import type { StageView } from './stage_view';

/** Between the machines and the page: situations go in, effects come out. */

export function act(app: App, controller: Controller, input: Input, situation: Situation): void {
  const { store } = app.services;
  // While a ruler is marked the pointer marks, whatever the tool.
  const { popover, measuring } = store.ui;
  const tool = popover === 'calibrate' && measuring?.kind === 'ruler' ? 'ruler' : store.ui.tool;
  for (const effect of controller.handle(tool, input, situation, store.ui.overlaysHidden)) apply(app, effect);
}

export function cancelGesture(app: App, view: StageView, controller: Controller): void {
  const situation = situationOf(app.services.store, view);
  if (situation) act(app, controller, { type: 'cancel', at: canvasPoint(0, 0), button: 'primary', alt: false }, situation);
}

export function situationOf(store: Store, view: StageView): Situation | null {
  const { state } = store;
  const frame = currentFrame(state);
  const place = currentPlace(state);
  if (!frame || !place) return null;
  const { outline } = currentCell(state);
  return { viewport: view.viewport(state), frame, place, outline, window: view.window(state), erase: state.ui.tracing.erase, hand: view.hand(state) };
}

function apply(app: App, effect: Effect): void {
  const { store } = app.services;
  switch (effect.type) {
    case 'perform':
      return store.perform(effect.command);
    case 'preview':
      return store.preview(effect.command);
    case 'commit':
      return store.commit(effect.command);
    case 'cancel-preview':
      return store.cancelPreview();
    case 'select':
      return store.show({ selectedPoint: effect.index });
    case 'viewport':
      return store.show({ viewport: effect.viewport });
    case 'mark':
      return app.calibrator.mark(effect.at, effect.begins);
    case 'tracing':
      return app.tracingTools.want(effect.intent);
  }
}
