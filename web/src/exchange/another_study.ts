import type { Offer } from '../document/store';
import { startEmpty } from '../document/start_anew';
import type { Doc } from '../document/types';
import type { Services } from '../jobs/services';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import type { Incoming } from './incoming';

/** So many of the files, evenly spaced, tell whether they are here already. */
const ASKED = 4;

/**
 * Are these files of frames others than those of the work? It is the same film where one of them is here, or could not be read before, and where
 * the work waits for its files, as one from a session without copies: what is amiss with those is told by name.
 */
export async function areOthers({ store, assets }: Pick<Services, 'store' | 'assets'>, files: readonly Incoming[]): Promise<boolean> {
  const { frames, unread } = store.doc;
  if (frames.length === 0 || files.some(({ name }) => unread.includes(name))) return false;
  if (frames.some(({ source }) => !assets.get(source))) return false;
  const step = Math.max(1, Math.floor(files.length / ASKED));
  for (const { name, blob } of files.filter((_, at) => at % step === 0)) {
    const { sha256 } = await assets.add(name, blob);
    if (frames.some(({ source }) => source === sha256)) return false;
  }
  return true;
}

/** Another study begins: what is open steps aside as it is, and the button that goes with the news brings it back. */
export function stepAside({ store }: Pick<Services, 'store'>): { readonly sentence: string; readonly offer: Offer } {
  const before: Doc = store.doc;
  startEmpty(store);
  const take = () => {
    store.perform({ label: texts.keep.openLabel, apply: () => before });
    store.show({ viewport: null, selectedPoint: null });
  };
  return { sentence: later.opening.steppedAside(before.name), offer: { label: later.opening.backTo(before.name), take } };
}
