import type { Doc, FrameEntry } from './types';

const known = new WeakMap<readonly FrameEntry[], ReadonlyMap<string, number>>();

/** Place of a frame in the film, from 0; -1 where the document has none such. */
export function indexOfFrame({ frames }: Pick<Doc, 'frames'>, frameId: string): number {
  let places = known.get(frames);
  if (!places) known.set(frames, (places = new Map(frames.map(({ id }, index) => [id, index]))));
  return places.get(frameId) ?? -1;
}

/** In the order of the film; what belongs to no frame of it is left out. */
export function inFilmOrder<T extends { readonly frameId: string }>(doc: Pick<Doc, 'frames'>, entries: readonly T[]): readonly T[] {
  const placed = entries.map((entry) => ({ entry, index: indexOfFrame(doc, entry.frameId) })).filter(({ index }) => index >= 0);
  return placed.toSorted((a, b) => a.index - b.index).map(({ entry }) => entry);
}
