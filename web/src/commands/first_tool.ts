import { currentCell, type Store } from '../document/store';
import { isReady } from '../results/steps';

/**
 * One click is the tool in hand as soon as it has all that it needs, unless somebody is tracing already; tracing is the first
 * tool where there is nothing but frames.
 */
export function takeFirstTool(store: Store): void {
  let wasReady = isReady(store.doc);
  store.subscribe(() => {
    const ready = isReady(store.doc);
    if (ready === wasReady) return;
    wasReady = ready;
    const { tool } = store.ui;
    if (ready && tool === 'trace' && currentCell(store.state).outline === null) store.show({ tool: 'one-click' });
    if (!ready && tool === 'one-click') store.show({ tool: 'trace' });
  });
}
