import { asSentence } from '../texts/sentences';
import { texts } from '../texts/texts';
import type { Command, Place } from './command';
import { withCell } from './commands';
import { bare } from './hand_poses';
import { isDiscarded, isSilhouette } from './laid_by';
import { type Candidate, type Cell, cellOf, type Doc, FOLLOWED, isFromFilm, type Outline, type Posed, type Result, type Verdict } from './types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { ComponentName } from '../terms/component';

/** What following a film gives to cells that nobody worked on. */

/** The same while the film is still followed: it has not been judged as a whole. */
const SO_FAR = 'followed so far from';

/** What became of a frame that was looked for a component. */
export interface Followed {
  readonly place: Place;
  /** Null where it was looked for and is not there. */
  readonly pose: PoseNumbers | null;
  readonly deviations: Candidate['deviations'];
  readonly residual: number | null;
  readonly doubtful: boolean;
  /** Above 1 it is doubtful, and the worst have the most. */
  readonly badness: number;
  /** From the other side of the mirror, where somebody may compare both. */
  readonly rival: Pick<Candidate, 'pose' | 'residual'> | null;
  /** It was followed from nothing but doubtful poses. */
  readonly led: boolean;
  /** The others were followed from it, and nobody had set it: the film has the word now. */
  readonly isLeader: boolean;
  /** A sentence without its full stop. */
  readonly because: string;
  /** The frames that it was followed from. */
  readonly from: string;
}

/** Nobody set what is there, so that following may say it. A click that found nothing fixes nothing, nor does a draft over what was followed. */
export function isFree(cell: Cell): boolean {
  const { outline, result } = cell;
  return isDiscarded(cell) || (!outline?.closed && (result === null ? outline === null : isFollowed(result)));
}

/** The outline of a free cell that stays: a draft, which has led to nothing yet. */
function draftOf(cell: Cell): Outline | null {
  return isDiscarded(cell) ? null : cell.outline;
}

/** The program found it, by itself or from a click, and nobody chose another. */
export function isFound({ outline, result }: Cell): boolean {
  return isSilhouette(outline) && result?.kind === 'posed' && result.from === 'outline' && result.chosen === 0;
}

/** Whether following said what is there, and nobody took another pose. */
export function isFollowed(result: Result | null): boolean {
  return isFromFilm(result) && (result?.kind !== 'posed' || result.chosen === 0);
}

/** Were the others followed from it, though nobody set it? It names itself as what it was followed from, on both sides. */
export function hasLed(result: Result | null): boolean {
  const [before, after] = isFollowed(result) ? result!.origin.split(' and ') : [];
  return after !== undefined && before!.endsWith(after);
}

/** Did a closed outline take the place of a pose that following found? Nobody who clicked beside something else would see it. */
export function gaveWay(before: Doc, after: Doc, { frameId, component }: Place): boolean {
  const { outline, result } = cellOf(before, frameId, component);
  const wasFollowed = !outline?.closed && result?.kind === 'posed' && isFromFilm(result);
  return wasFollowed && cellOf(after, frameId, component).outline?.closed === true;
}

/** Was it found by following that has not come to its end? */
export function isSoFar(result: Result | null): boolean {
  return result?.kind === 'posed' && result.from === 'film' && result.origin.startsWith(SO_FAR);
}

/** Frames in which a component is followed so far, and not judged with the film as a whole. */
export function unjudged(doc: Doc, component: ComponentName): number {
  return doc.frames.filter(({ id }) => isSoFar(cellOf(doc, id, component).result)).length;
}

/** Where the component seems to be in a frame, while the others are looked at. No unit of undo. */
export function withSoFar(doc: Doc, place: Place, pose: PoseNumbers, from: string): Doc {
  const cell = cellOf(doc, place.frameId, place.component);
  if (!isFree(cell)) return doc;
  const because = texts.follow.soFar;
  const result = posedBy(`${SO_FAR} ${from}`, bare(pose), { word: 'doubtful', because }, null);
  return withCell(doc, place, { outline: draftOf(cell), result, resultOf: null });
}

/** The cells as they were before they were followed so far. */
export function withoutSoFar(doc: Doc, before: readonly (readonly [Place, Cell])[]): Doc {
  return before.reduce((changed, [place, was]) => {
    const now = cellOf(changed, place.frameId, place.component);
    return isSoFar(now.result) ? withCell(changed, place, { ...was, outline: now.outline ?? was.outline }) : changed;
  }, doc);
}

/** Takes what following found: one step back for all of it. What a person did meanwhile stays. */
export function takeFollowed(found: readonly Followed[]): Command {
  return { label: texts.steps.follow, apply: (doc) => found.reduce(withFollowed, doc) };
}

function withFollowed(doc: Doc, one: Followed): Doc {
  const cell = cellOf(doc, one.place.frameId, one.place.component);
  if (one.isLeader && !isFollowed(cell.result)) return isFound(cell) ? withCell(doc, one.place, { outline: null, result: resultOf(one), resultOf: null }) : doc;
  return isFree(cell) ? withCell(doc, one.place, { outline: draftOf(cell), result: resultOf(one), resultOf: null }) : doc;
}

function resultOf({ pose, deviations, residual, doubtful, badness, rival, led, because, from }: Followed): Result {
  const origin = `${FOLLOWED} ${from}`;
  const sentence = asSentence(because);
  if (!pose) return { kind: 'failed', origin, sentence };
  const own: Verdict = { word: doubtful ? 'doubtful' : 'good', because };
  const rivals = rival ? [{ ...bare(rival.pose), residual: rival.residual }] : [];
  const posed = posedBy(origin, { ...bare(pose), residual, deviations }, own, sentence);
  const result = { ...posed, candidates: [...posed.candidates, ...rivals], doubt: badness };
  return led && !doubtful ? asLed({ ...result, own }, true) : result;
}

/** A pose that was followed from doubtful ones, as they are now; the same object where nothing changes. */
export function asLed(result: Posed, isDoubtful: boolean): Posed {
  const { verdict, own = null } = result;
  const { fromDoubtful } = texts.follow;
  if ((verdict?.because === fromDoubtful) === isDoubtful) return result;
  return { ...result, verdict: isDoubtful ? { word: 'doubtful', because: fromDoubtful } : own };
}

function posedBy(origin: string, candidate: Candidate, verdict: Verdict, reason: string | null): Posed {
  return { kind: 'posed', from: 'film', origin, candidates: [candidate], chosen: 0, reason, decided: true, verdict };
}
