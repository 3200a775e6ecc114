import type { Store } from '../document/store';
import { texts } from '../texts/texts';

const KEY = 'fluoropose lost jobs';

/** Notes what was under way when the page goes; the page that comes after it in the same tab says so. */
export function tellLostJobs(store: Store, tab: Pick<Storage, 'getItem' | 'setItem' | 'removeItem'>): void {
  window.addEventListener('pagehide', () => {
    const titles = store.ui.jobs.map(({ title }) => title);
    if (titles.length > 0) tab.setItem(KEY, JSON.stringify(titles));
  });
  const kept = tab.getItem(KEY);
  tab.removeItem(KEY);
  const titles: unknown = kept === null ? [] : JSON.parse(kept);
  if (!Array.isArray(titles) || titles.length === 0) return;
  store.say('info', texts.keep.lost(texts.listed(titles.map(String))));
}
