import type { Command } from '../document/command';
import type { FrameEntry } from '../document/types';
import type { Services } from '../jobs/services';
import { later } from '../texts/later';

/** Frames stand in the order of their files' names. Where files of a series say that they were taken in another one, a person says which is meant. */
export function offerStatedOrder({ store, studio }: Services, framesCame: boolean): void {
  const { frames } = store.doc;
  const stated = framesCame && statedOrder(frames, ({ id }) => studio.statedGeometry(id)?.place ?? null);
  if (!stated) return;
  const words = later.opening;
  const { notice } = store.ui;
  const take = () => {
    store.perform(inOrder(stated));
    store.goTo(0);
    store.say('info', words.taken(stated[0]!.name));
  };
  const sentence = words.otherOrder(frames[0]!.name, stated[0]!.name);
  store.say(notice?.kind ?? 'info', notice ? `${sentence} ${notice.text}` : sentence, { label: words.take, take });
}

/** The frames by the places that their files state; null where that is the order in which they stand, or where not every file has a place of its own. */
export function statedOrder(frames: readonly FrameEntry[], placeOf: (frame: FrameEntry) => number | null): readonly FrameEntry[] | null {
  const places = new Map(frames.map((frame) => [frame, placeOf(frame)]));
  const placed = (frame: FrameEntry) => places.get(frame) ?? NaN;
  if (frames.some((frame) => Number.isNaN(placed(frame))) || new Set(places.values()).size < frames.length) return null;
  const sorted = [...frames].sort((a, b) => placed(a) - placed(b));
  return sorted.every((frame, at) => frame === frames[at]) ? null : sorted;
}

/** Frames that came since stay behind those. */
function inOrder(wanted: readonly FrameEntry[]): Command {
  const ids = wanted.map(({ id }) => id);
  return {
    label: later.opening.step,
    apply: (doc) => {
      const known = ids.flatMap((id) => doc.frames.find((frame) => frame.id === id) ?? []);
      return { ...doc, frames: [...known, ...doc.frames.filter(({ id }) => !ids.includes(id))] };
    },
  };
}
