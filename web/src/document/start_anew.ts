import * as commands from './commands';
import type { Store } from './store';

/** An empty document on view; undo brings back what was there. */
export function startEmpty(store: Store): void {
  store.perform(commands.startAnew());
  store.show({ viewport: null, popover: null, proposal: null, savedAt: null, selectedPoint: null });
  store.goTo(0);
}
