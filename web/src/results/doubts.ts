import type { Place } from '../document/command';
import { isFollowed } from '../document/followed';
import { checkState, markOf } from '../document/marks';
import { type Cell, cellKey, cellOf, type Doc, type Failed, type Posed, verdictOf } from '../document/types';
import { COMPONENT_NAMES } from '../terms/component';

/** What somebody is to look at and nobody has: a pose that may be wrong, or a cell in which none was found. */
export interface Doubt {
  readonly place: Place;
  /** Of the frame, from 0. */
  readonly index: number;
  readonly result: Posed | Failed;
}

/** The worst first: those that others were followed from, then the others by how bad they are; cells without a pose last, as what is corrected before may fill them. */
export function doubtsOf(doc: Doc): readonly Doubt[] {
  const found = COMPONENT_NAMES.flatMap((component) =>
    doc.frames.flatMap(({ id: frameId }, index): Doubt[] => {
      const place = { frameId, component };
      const cell = cellOf(doc, frameId, component);
      return isOpen(cell) && cell.result && checkState(cell, markOf(doc, place)) !== 'yes' ? [{ place, index, result: cell.result }] : [];
    }),
  );
  // Sorting keeps the order of equals.
  return found.map((one) => ({ one, rank: rank(one.result) })).toSorted((a, b) => (a.rank === b.rank ? 0 : b.rank - a.rank)).map(({ one }) => one);
}

function isOpen({ result }: Cell): boolean {
  return result?.kind === 'failed' || verdictOf(result)?.word === 'doubtful';
}

function rank(result: Posed | Failed): number {
  if (result.kind === 'failed') return -Infinity;
  return isFollowed(result) ? (result.doubt ?? 0) : Infinity;
}

/** The one after a place, or before it, around the whole list; the worst from a place that is not doubtful. */
export function nextDoubt(doc: Doc, from: Place | null, step: 1 | -1): Doubt | null {
  const queue = doubtsOf(doc);
  const at = from ? queue.findIndex(({ place }) => keyOf(place) === keyOf(from)) : -1;
  if (at < 0) return queue.at(step > 0 ? 0 : -1) ?? null;
  return queue[(at + step + queue.length) % queue.length] ?? null;
}

function keyOf({ frameId, component }: Place): string {
  return cellKey(frameId, component);
}
