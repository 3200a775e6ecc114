import { checkState, markOf } from '../document/marks';
import type { State } from '../document/store';
import { cellOf, chosenCandidate, type Doc, verdictOf } from '../document/types';
import type { FramePoint } from '../geometry/points';
import { isInside } from '../geometry/rings';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { spanToFollow } from './spans';

/** The work's steps, and what the next one needs. */

export const STEPS = ['open', 'first', 'follow', 'check', 'joint'] as const;
export type Step = (typeof STEPS)[number];

/** All that the steps depend on, read off a document once. */
export interface Standing {
  readonly step: Step;
  /** Components with a model that have no pose in any frame, so that one has to be clicked or found. */
  readonly unposed: readonly ComponentName[];
  /** Frames that following would fill, of all components. */
  readonly free: number;
  /** Cells whose pose may be wrong, and nobody checked it. */
  readonly doubtful: number;
}

const standings = new WeakMap<Doc, Standing>();

export function standingOf(doc: Doc): Standing {
  const known = standings.get(doc);
  if (known) return known;
  const found = lookedUp(doc);
  standings.set(doc, found);
  return found;
}

function lookedUp(doc: Doc): Standing {
  const modelled = COMPONENT_NAMES.filter((component) => doc.components[component].model !== null);
  const unposed = modelled.filter((component) => doc.frames.every(({ id }) => !chosenCandidate(cellOf(doc, id, component))));
  const free = doc.frames.length < 2 ? 0 : modelled.reduce((sum, component) => sum + (spanToFollow(doc, component)?.free ?? 0), 0);
  const doubtful = COMPONENT_NAMES.reduce((sum, component) => sum + doc.frames.filter(({ id }) => isOpen(doc, id, component)).length, 0);
  const isAny = doc.frames.some(({ id }) => COMPONENT_NAMES.some((component) => chosenCandidate(cellOf(doc, id, component))));
  const step = !isReady(doc) && !isAny ? 'open' : unposed.length > 0 || !isAny ? 'first' : free > 0 ? 'follow' : doubtful > 0 ? 'check' : 'joint';
  return { step, unposed, free, doubtful };
}

/** Nothing is missing for a pose by one click. */
export function isReady(doc: Doc): boolean {
  return doc.frames.length > 0 && doc.calibration !== null && COMPONENT_NAMES.some((component) => doc.components[component].model !== null);
}

function isOpen(doc: Doc, frameId: string, component: ComponentName): boolean {
  const cell = cellOf(doc, frameId, component);
  return verdictOf(cell.result)?.word === 'doubtful' && checkState(cell, markOf(doc, { frameId, component })) !== 'yes';
}

/**
 * The component that a click means: the selected one, but where that has its pose and the other has none in the whole film, a
 * click beside the outline there is means the other.
 */
export function componentMeant(state: State, at: FramePoint): ComponentName {
  const { component, frameIndex } = state.ui;
  const doc = state.history.present;
  const other = component === 'femur' ? 'tibia' : 'femur';
  const { outline, result } = cellOf(doc, doc.frames[frameIndex]?.id, component);
  const isDone = result?.kind === 'posed' && outline !== null && !isInside(outline.points, at);
  return isDone && standingOf(doc).unposed.includes(other) ? other : component;
}

/** What the card on the film asks for; null where it has nothing to say. */
export type Guide = { readonly ask: 'click'; readonly component: ComponentName; readonly isPreparing: boolean } | { readonly ask: 'follow' };

export function guideOf(state: State): Guide | null {
  const doc = state.history.present;
  const { tool, component, following, libraries } = state.ui;
  if (tool !== 'one-click' || following || !isReady(doc)) return null;
  const { unposed, free } = standingOf(doc);
  const wanted = unposed.includes(component) ? component : unposed[0];
  if (wanted) return { ask: 'click', component: wanted, isPreparing: libraries[wanted].state === 'building' };
  return free > 0 ? { ask: 'follow' } : null;
}
