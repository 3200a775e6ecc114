import type { ComponentName } from '../terms/component';
import { partsOf } from './cells';
import type { Command, Place } from './command';
import { cellKey, cellOf, chosenCandidate, type Cell, type Doc, type Mark, verdictOf } from './types';
import { texts } from '../texts/texts';

export const NO_MARK: Mark = { checked: null, flagged: false, note: '' };

export function markOf(doc: Doc, { frameId, component }: Place): Mark {
  return doc.marks[cellKey(frameId, component)] ?? NO_MARK;
}

/** Nothing to check yet: neither an outline nor a pose, nor was one looked for. That nothing was found may be right: the component is not there. */
export function canBeChecked(cell: Cell): boolean {
  return cell.outline !== null || cell.result?.kind === 'failed' || chosenCandidate(cell) !== null;
}

export type CheckState = 'no' | 'yes' | 'changed since';

/** A check is of what was looked at: when the outline or the pose changes afterwards it says so. */
export function checkState(cell: Cell, mark: Mark): CheckState {
  if (mark.checked === null) return 'no';
  return mark.checked === fingerprint(cell) ? 'yes' : 'changed since';
}

/** A person found right what the page doubts. */
export function isAccepted(cell: Cell, mark: Mark): boolean {
  return verdictOf(cell.result)?.word === 'doubtful' && checkState(cell, mark) === 'yes';
}

/** Marks what is there now as checked, or takes the mark away where it still holds. */
export function toggleChecked(place: Place): Command {
  return onMark(texts.steps.check, place, (mark, cell) => {
    if (checkState(cell, mark) === 'yes') return { ...mark, checked: null };
    return canBeChecked(cell) ? { ...mark, checked: fingerprint(cell) } : { ...mark, checked: null };
  });
}

export function toggleFlagged(place: Place): Command {
  return onMark('flag', place, (mark) => ({ ...mark, flagged: !mark.flagged }));
}

/** Typing is one unit of undo for each cell. */
export function setNote(place: Place, note: string): Command {
  const mergeKey = `note ${cellKey(place.frameId, place.component)}`;
  return { ...onMark(texts.steps.writeNote, place, (mark) => ({ ...mark, note })), mergeKey };
}

/** No fingerprint: what was looked at is there no more. */
const GONE = 'gone';

/** The marks once all poses of components are others: they say that their cells changed since. */
export function withOtherPoses(doc: Doc, isConcerned: (frameId: string, component: ComponentName) => boolean): Doc['marks'] {
  const changed = ([key, mark]: [string, Mark]): [string, Mark] => {
    const [frameId, component] = partsOf(key);
    const isOther = mark.checked !== null && isConcerned(frameId, component) && chosenCandidate(cellOf(doc, frameId, component)) !== null;
    return [key, isOther ? { ...mark, checked: GONE } : mark];
  };
  return Object.fromEntries(Object.entries(doc.marks).map(changed));
}

function onMark(label: string, place: Place, change: (mark: Mark, cell: Cell) => Mark): Command {
  return {
    label,
    place,
    apply: (doc) => {
      const key = cellKey(place.frameId, place.component);
      const before = markOf(doc, place);
      const after = change(before, cellOf(doc, place.frameId, place.component));
      if (same(before, after)) return doc;
      const { [key]: _, ...others } = doc.marks;
      return { ...doc, marks: same(after, NO_MARK) ? others : { ...others, [key]: after } };
    },
  };
}

function same(a: Mark, b: Mark): boolean {
  return a.checked === b.checked && a.flagged === b.flagged && a.note === b.note;
}

const fingerprints = new WeakMap<Cell, string>();

/** Of an outline and the chosen pose: enough to notice a change, no proof of identity. */
function fingerprint(cell: Cell): string {
  const known = fingerprints.get(cell);
  if (known !== undefined) return known;
  const { outline } = cell;
  const pose = chosenCandidate(cell)?.pose;
  const shape = outline && [outline.closed ? 1 : 0, ...outline.points.flatMap(({ column, row }) => [column, row]), NaN, ...outline.unknownSides];
  const numbers = pose && [pose.x, pose.y, pose.z, pose.zRot, pose.xRot, pose.yRot];
  const made = `${fnv(shape ?? [])}-${fnv(numbers ?? [])}`;
  fingerprints.set(cell, made);
  return made;
}

/** FNV-1a over the bytes of the numbers, 32 bits. */
function fnv(numbers: readonly number[]): string {
  const bytes = new Uint8Array(Float64Array.from(numbers).buffer);
  let hash = 0x811c9dc5;
  for (const byte of bytes) hash = Math.imul(hash ^ byte, 0x01000193);
  return (hash >>> 0).toString(16).padStart(8, '0');
}
