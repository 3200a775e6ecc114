import { unjudged } from '../document/followed';
import type { Store } from '../document/store';
import { COMPONENT_NAMES } from '../terms/component';
import { texts } from '../texts/texts';
import { attempt } from './attempt';

const KEY = 'fluoropose lost jobs';

/**
 * Notes what was under way when the page goes; the page that comes after it in the same tab says so. Following a film that was cut off,
 * which the film itself tells too, can be gone on with from there: that waits for an answer. A tab that keeps nothing is no trouble.
 */
export function tellLostJobs(store: Store, tab: Pick<Storage, 'getItem' | 'setItem' | 'removeItem'> | null, follow: () => void): void {
  window.addEventListener('pagehide', () => {
    const { jobs, following } = store.ui;
    const titles = following ? [texts.follow.job] : jobs.map(({ title }) => title);
    if (titles.length > 0) attempt(() => tab?.setItem(KEY, JSON.stringify(titles)));
  });
  const kept = attempt(() => tab?.getItem(KEY) ?? null);
  attempt(() => tab?.removeItem(KEY));
  const read: unknown = attempt(() => JSON.parse(kept ?? '[]'));
  const titles = Array.isArray(read) ? read.map(String) : [];
  const isCutOff = COMPONENT_NAMES.some((component) => unjudged(store.doc, component) > 0);
  if (isCutOff && !titles.includes(texts.follow.job)) titles.push(texts.follow.job);
  if (titles.length === 0) return;
  const offer = { label: texts.follow.button, take: follow };
  store.say('info', texts.keep.lost(texts.listed(titles)), titles.includes(texts.follow.job) ? offer : undefined);
}
