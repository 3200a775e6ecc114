import { hasUnsavedWork } from '../document/history';
import type { Store } from '../document/store';

/** Asks before the page is left with unsaved work; says so in the tab's title too. */
export function guardAgainstLoss(store: Store): void {
  window.addEventListener('beforeunload', (event) => {
    if (hasUnsavedWork(store.state.history)) event.preventDefault();
  });
  let shown = '';
  store.subscribe(() => {
    const mark = hasUnsavedWork(store.state.history) ? '• ' : '';
    const title = store.doc.name === '' ? 'fluoropose' : `${mark}${store.doc.name} – fluoropose`;
    if (title !== shown) document.title = shown = title;
  });
}
