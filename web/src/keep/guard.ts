import { hasUnsavedWork } from '../document/history';
import type { State, Store } from '../document/store';
import type { Keeper } from './keeper';

/** Would closing the page now cost work? It is neither in the browser's storage nor in a session file. */
function isAtRisk({ history, ui }: State): boolean {
  return (ui.keeping.state === 'pending' || ui.keeping.state === 'refused') && hasUnsavedWork(history);
}

/** Writes what waits before the page goes, and asks where that may come too late; says so in the tab's title too. */
export function guardAgainstLoss(store: Store, keeper: Pick<Keeper, 'flush'>): void {
  window.addEventListener('beforeunload', (event) => {
    keeper.flush();
    if (isAtRisk(store.state)) event.preventDefault();
  });
  window.addEventListener('pagehide', () => keeper.flush());
  document.addEventListener('visibilitychange', () => {
    if (document.visibilityState === 'hidden') keeper.flush();
  });
  let shown = '';
  store.subscribe(() => {
    const mark = isAtRisk(store.state) ? '• ' : '';
    const title = store.doc.name === '' ? 'fluoropose' : `${mark}${store.doc.name} – fluoropose`;
    if (title !== shown) document.title = shown = title;
  });
}
