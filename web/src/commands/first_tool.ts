import type { Store } from '../document/store';
import { isReady } from '../results/steps';

/**
 * One click is the tool in hand as soon as it has all that it needs, unless somebody has begun otherwise; tracing is the first
 * tool where there is nothing but frames.
 */
export function takeFirstTool(store: Store): void {
  let wasReady = isReady(store.doc);
  store.subscribe(() => {
    const ready = isReady(store.doc);
    if (ready === wasReady) return;
    wasReady = ready;
    const { tool } = store.ui;
    const isBegun = !store.doc.cells.isEmpty;
    if (ready && tool === 'trace' && !isBegun) store.show({ tool: 'one-click' });
    if (!ready && tool === 'one-click') store.show({ tool: 'trace' });
  });
}
