import type { Place } from '../document/command';
import { isSoFar } from '../document/followed';
import { checkState, markOf, type CheckState } from '../document/marks';
import { type Cell, cellOf, type Doc, type FrameEntry, isByHand, isRefined, type Mark, type Result, verdictOf } from '../document/types';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';

/** How far a cell is, from nothing to a refined pose. */
export type Stage = 'empty' | 'draft' | 'traced' | 'posed' | 'refined' | 'by hand' | 'followed' | 'followed so far' | 'pose loaded' | 'no pose';

/** All that a list says of a cell. */
export interface Progress {
  readonly stage: Stage;
  /** Model, calibration or library have changed since the pose was found. */
  readonly outdated: boolean;
  /**
   * It may be wrong, and nobody checked it: by its verdict, or of sessions without one, as nothing but a slightly smaller residual
   * spoke for it.
   */
  readonly doubtful: boolean;
  /** A pose of what is there now. */
  readonly posed: boolean;
  readonly check: CheckState;
  readonly flagged: boolean;
  readonly note: string;
}

/** `key`: what a pose of this cell would be found with now (`poseKey`); null where something is missing. */
export function progressOf(cell: Cell, mark: Mark, key: string | null): Progress {
  const stage = stageOf(cell);
  const outdated = isOutdatedResult(cell, key);
  const check = checkState(cell, mark);
  return {
    stage,
    outdated,
    doubtful: check !== 'yes' && isDoubtful(cell),
    posed: POSED.includes(stage) && !outdated,
    check,
    flagged: mark.flagged,
    note: mark.note,
  };
}

const POSED: readonly Stage[] = ['posed', 'refined', 'by hand', 'followed', 'followed so far', 'pose loaded'];

function stageOf({ outline, result }: Cell): Stage {
  if (result?.kind === 'failed') return 'no pose';
  if (result?.kind !== 'posed') return outline ? (outline.closed ? 'traced' : 'draft') : 'empty';
  if (result.from === 'file') return 'pose loaded';
  if (isByHand(result)) return 'by hand';
  if (result.from === 'film') return isSoFar(result) ? 'followed so far' : 'followed';
  return isRefined(result) ? 'refined' : 'posed';
}

function isOutdatedResult({ result }: Cell, key: string | null): boolean {
  return result?.kind === 'posed' && result.from === 'outline' && result.origin !== key;
}

function isDoubtful({ result }: Cell): boolean {
  const verdict = verdictOf(result);
  return verdict ? verdict.word === 'doubtful' : isAmbiguous(result);
}

function isAmbiguous(result: Result | null): boolean {
  if (result?.kind !== 'posed' || result.from !== 'outline' || !isRefined(result)) return false;
  return result.candidates.length > 1 && result.chosen === 0 && !result.decided;
}

// --- Lists ----------------------------------------------------------------------------------------------------------

/** A cell with its place in the sequence. */
export interface Entry {
  readonly place: Place;
  readonly frame: FrameEntry;
  /** From 0. */
  readonly index: number;
  readonly progress: Progress;
}

type KeyOf = (component: ComponentName, frame: FrameEntry) => string | null;

/** Component by component, as a sequence is traced. */
export function entriesOf(doc: Doc, keyOf: KeyOf, components: readonly ComponentName[] = COMPONENT_NAMES): readonly Entry[] {
  return components.flatMap((component) =>
    doc.frames.map((frame, index) => {
      const place = { frameId: frame.id, component };
      const progress = progressOf(cellOf(doc, frame.id, component), markOf(doc, place), keyOf(component, frame));
      return { place, frame, index, progress };
    }),
  );
}

export const FILTERS = ['all', 'unfinished', 'unchecked', 'doubtful', 'flagged'] as const;
export type Filter = (typeof FILTERS)[number];

export function passes({ progress }: Entry, filter: Filter): boolean {
  switch (filter) {
    case 'all':
      return true;
    case 'unfinished':
      // Somebody said that there is nothing to find.
      return !progress.posed && !(progress.stage === 'no pose' && progress.check === 'yes');
    case 'unchecked':
      return progress.posed && progress.check !== 'yes';
    case 'doubtful':
      return progress.doubtful;
    case 'flagged':
      return progress.flagged;
  }
}

/** Components that somebody works on: with a model, a library, an outline or a pose. */
export function componentsInWork(doc: Doc, selected: ComponentName): readonly ComponentName[] {
  const has = (component: ComponentName) => {
    const { model, libraryFile } = doc.components[component];
    return model !== null || libraryFile !== null || doc.frames.some((frame) => isBegun(cellOf(doc, frame.id, component)));
  };
  const found = COMPONENT_NAMES.filter((component) => component === selected || has(component));
  return found;
}

function isBegun({ outline, result }: Cell): boolean {
  return outline !== null || result !== null;
}

/** The next thing to do from a place, around the whole list: what has no pose; once all have one, what is doubtful, and then what nobody checked. */
export function nextTask(
  doc: Doc,
  keyOf: KeyOf,
  from: { readonly index: number; readonly component: ComponentName },
  step: 1 | -1,
): { readonly entry: Entry; readonly filter: 'unfinished' | 'doubtful' | 'unchecked' } | null {
  const entries = entriesOf(doc, keyOf, componentsInWork(doc, from.component));
  const here = entries.findIndex(({ index, place }) => index === from.index && place.component === from.component);
  for (const filter of ['unfinished', 'doubtful', 'unchecked'] as const) {
    for (let away = 1; away <= entries.length; away++) {
      const entry = entries[(((here + step * away) % entries.length) + entries.length) % entries.length];
      if (entry && passes(entry, filter)) return { entry, filter };
    }
  }
  return null;
}
