import type { State } from '../document/store';
import { cellOf, chosenCandidate, type Doc } from '../document/types';
import type { FramePoint } from '../geometry/points';
import { isInside } from '../geometry/rings';
import { COMPONENT_NAMES, type ComponentName, otherThan } from '../terms/component';
import { doubtsOf } from './doubts';
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
  /** Components that would be followed from doubtful poses alone. */
  readonly shaky: readonly ComponentName[];
  /** Cells whose pose may be wrong, and nobody checked it. */
  readonly doubtful: number;
  /** Cells in which none was found, and nobody said that nothing is there. */
  readonly lacking: number;
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
  const spans = doc.frames.length < 2 ? [] : modelled.flatMap((component) => ({ component, span: spanToFollow(doc, component) }));
  const free = spans.reduce((sum, { span }) => sum + (span?.free ?? 0), 0);
  const shaky = spans.flatMap(({ component, span }) => (span?.isDoubtful ? [component] : []));
  const doubts = doubtsOf(doc);
  const lacking = doubts.filter(({ result }) => result.kind === 'failed').length;
  const doubtful = doubts.length - lacking;
  const isAny = doc.frames.some(({ id }) => COMPONENT_NAMES.some((component) => chosenCandidate(cellOf(doc, id, component))));
  const step = !isReady(doc) && !isAny ? 'open' : unposed.length > 0 || !isAny ? 'first' : free > 0 ? 'follow' : doubts.length > 0 ? 'check' : 'joint';
  return { step, unposed, free, shaky, doubtful, lacking };
}

/** Nothing is missing for a pose by one click. */
export function isReady(doc: Doc): boolean {
  return doc.frames.length > 0 && doc.calibration !== null && COMPONENT_NAMES.some((component) => doc.components[component].model !== null);
}

/** A joint can come about. */
export function hasBothComponents(doc: Doc): boolean {
  return COMPONENT_NAMES.every((component) => {
    const { model, libraryFile } = doc.components[component];
    return model !== null || libraryFile !== null || doc.frames.some(({ id }) => chosenCandidate(cellOf(doc, id, component)));
  });
}

/** What no frame can have a pose without, and nobody gave; null where all is there or there is no frame yet. */
export function whatIsMissing(doc: Doc): 'calibration' | ComponentName | null {
  if (doc.frames.length === 0) return null;
  if (doc.calibration === null) return 'calibration';
  const isAny = COMPONENT_NAMES.some((component) => doc.components[component].model !== null || doc.components[component].libraryFile !== null);
  return isAny ? null : 'femur';
}

/**
 * The component that a click means: the selected one, but where that has its pose, or was just clicked, and the other has
 * neither in the whole film, a click beside it means the other.
 */
export function componentMeant(state: State, at: FramePoint): ComponentName {
  const { component, frameIndex, jobs } = state.ui;
  const doc = state.history.present;
  const frame = doc.frames[frameIndex];
  const other = otherThan(component);
  if (!frame || !awaitsClick(state).includes(other)) return component;
  const clicked = jobs.find(({ place, at }) => at && place?.frameId === frame.id && place.component === component)?.at;
  if (clicked) return isSame(clicked, at, frame.width) ? component : other;
  const { outline, result } = cellOf(doc, frame.id, component);
  return result?.kind === 'posed' && outline !== null && !isInside(outline.points, at) ? other : component;
}

/** The component that a tool outlines when it is taken: the selected one, but where that has its outline, or was just clicked, the one that the card asks for. */
export function componentToOutline(state: State): ComponentName {
  const { component, frameIndex, jobs } = state.ui;
  const doc = state.history.present;
  const id = doc.frames[frameIndex]?.id;
  const awaited = awaitsClick(state);
  const isTaken = cellOf(doc, id, component).outline?.closed || jobs.some(({ place, at }) => at && place?.frameId === id && place?.component === component);
  return isTaken && isReady(doc) && awaited.length > 0 && !awaited.includes(component) ? otherThan(component) : component;
}

/** A second click this near to the first, as a part of the frame, is the same once more. */
const SAME = 0.03;

function isSame(a: FramePoint, b: FramePoint, width: number): boolean {
  return Math.hypot(a.column - b.column, a.row - b.row) < SAME * width;
}

/** Components without a pose that nobody has clicked just now. */
function awaitsClick(state: State): readonly ComponentName[] {
  const { jobs } = state.ui;
  return standingOf(state.history.present).unposed.filter((component) => !jobs.some(({ place, at }) => at && place?.component === component));
}

/** What the card on the film asks for; null where it has nothing to say. */
export type Guide = { readonly ask: 'click'; readonly component: ComponentName; readonly isPreparing: boolean } | { readonly ask: 'follow' };

export function guideOf(state: State): Guide | null {
  const doc = state.history.present;
  const { tool, component, following, checking, libraries } = state.ui;
  if (tool !== 'one-click' || following || checking || !isReady(doc)) return null;
  const { unposed, free } = standingOf(doc);
  const awaited = awaitsClick(state);
  const wanted = awaited.includes(component) ? component : awaited[0];
  // A click leads to no pose there; why, the card of the pose says.
  if (wanted && libraries[wanted].state === 'stopped') return null;
  if (wanted) return { ask: 'click', component: wanted, isPreparing: libraries[wanted].state === 'building' };
  return free > 0 && unposed.length === 0 ? { ask: 'follow' } : null;
}
