import type { CanvasPoint } from '../geometry/points';
import type { App } from '../commands/app';
import type { StageView } from './stage_view';

/** A double click on a model takes it in hand; tools that draw keep theirs. True if it was taken. */
export function takeModel({ services, actions }: App, view: StageView, at: CanvasPoint): boolean {
  const { store } = services;
  const { tool, overlaysHidden } = store.ui;
  if ((tool !== 'edit' && tool !== 'hand') || overlaysHidden || actions.stage?.busy()) return false;
  const component = view.modelAt(at);
  if (!component) return false;
  store.selectComponent(component);
  store.show({ tool: 'pose' });
  return true;
}
