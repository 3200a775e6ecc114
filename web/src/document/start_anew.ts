import * as commands from './commands';
import type { Store } from './store';

/** An empty document on view, and the first tool in hand as if nothing had been there; undo brings back what was. */
export function startEmpty(store: Store): void {
  store.perform(commands.startAnew());
  store.show({ viewport: null, popover: null, proposal: null, savedAt: null, selectedPoint: null, tool: 'trace', component: 'femur', checking: false });
  store.goTo(0);
}
