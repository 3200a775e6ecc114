import { readTaste, writeTaste } from './taste_text';
import type { Store } from '../document/store';
import { attempt } from './attempt';

const KEY = 'fluoropose-taste';

/** Brings back how things were shown last, and remembers every change. A browser that keeps nothing is no trouble. */
export function rememberTaste(store: Store, storage: Pick<Storage, 'getItem' | 'setItem'> | null = browserStorage()): void {
  const taste = readTaste(attempt(() => storage?.getItem(KEY) ?? null));
  if (taste) store.show(taste);
  let kept = store.ui;
  store.subscribe(() => {
    const { seeing, hand } = store.ui;
    if (seeing === kept.seeing && hand === kept.hand) return;
    kept = store.ui;
    attempt(() => storage?.setItem(KEY, writeTaste({ seeing, hand })));
  });
}

/** Even to ask for it may be forbidden. */
function browserStorage(): Storage | null {
  return attempt(() => window.localStorage) ?? null;
}
