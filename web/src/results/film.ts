import { inFilmOrder, indexOfFrame } from '../document/frame_index';
import { CONSTANTS, filmNumbers, sameFilm } from '../document/film';
import { hasLed } from '../document/followed';
import { checkState, markOf } from '../document/marks';
import { type Candidate, type Cell, cellKey, cellOf, type Doc, type FrameEntry, type KnownFilm, type Posed, UNMET, type Verdict, verdictAlone } from '../document/types';
import { type CellEntry, CellIndex } from '../document/cells';
import type { Place } from '../document/command';
import { inCamera, turnBetween, type Vector } from '../geometry/pose_motion';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { texts } from '../texts/texts';
import type { FilmMisfits } from '../workers/protocol/film';
import { poseKey, poseKeys } from './keys';

/** What the study's own frames tell of their film, and which poses it concerns. */

/** Frames of each component that are asked: more tell hardly more. */
const FRAMES = 16;

/** A cell whose pose is good enough to read profiles across its outline. */
export interface Witness {
  readonly key: string;
  readonly frameId: string;
  readonly component: ComponentName;
  /** Place in the sequence, from 0. */
  readonly frame: number;
  readonly pose: PoseNumbers;
  readonly isDoubtful: boolean;
  /** The film was followed from it, and stays as it was read there. */
  readonly hasLed: boolean;
}

const onFrames = new CellIndex<Cell>(({ cell: { result } }) => result?.kind === 'posed' && result.onFrame !== undefined);

/** Cells whose poses were found on frames themselves. */
export function foundOnFrames(doc: Doc): readonly CellEntry<Cell>[] {
  return inFilmOrder(doc, onFrames.in(doc.cells));
}

/** Was any pose found on a frame itself? */
export function meetsFrames(doc: Doc): boolean {
  return onFrames.in(doc.cells).length > 0;
}

/**
 * The cells that tell of the film. What somebody only placed by hand does not: it may lie anywhere. What is doubtful does where
 * nothing better does, unless somebody checked it: a tray on the wrong rim would bend the film to explain it.
 */
export function witnesses(doc: Doc, isReady: (component: ComponentName, frame: FrameEntry) => boolean, isKnown: (key: string) => boolean = () => false): readonly Witness[] {
  const entries = inFilmOrder(doc, mayTell.in(doc.cells));
  const keyOf = poseKeys(doc);
  return COMPONENT_NAMES.flatMap((component) => {
    const found = entries.flatMap(({ frameId, component: of, cell }): Witness[] => {
      const frame = indexOfFrame(doc, frameId);
      const entry = doc.frames[frame]!;
      const candidate = of === component ? toldBy(cell, keyOf(component, entry)) : null;
      if (!candidate || !isReady(component, entry)) return [];
      const isChecked = checkState(cell, markOf(doc, { frameId: entry.id, component })) === 'yes';
      const isDoubtful = !isChecked && verdictAlone(cell.result)?.word === 'doubtful';
      return [{ key: cellKey(entry.id, component), frameId: entry.id, component, frame, pose: candidate.pose, isDoubtful, hasLed: hasLed(cell.result) }];
    });
    const good = found.filter(({ isDoubtful }) => !isDoubtful);
    const told = good.length > 0 ? good : found;
    // Who was asked before stays, wherever others come.
    return told.toSorted((a, b) => Number(isKnown(b.key)) - Number(isKnown(a.key))).slice(0, FRAMES);
  });
}

const mayTell = new CellIndex<Cell>(({ cell: { result } }) => result?.kind === 'posed' && (result.from !== 'film' || hasLed(result)));

function toldBy({ result, outline, resultOf }: Cell, key: string | null): Candidate | null {
  // What was followed rests on the film as it was known then, and what it was followed from told it.
  if (result?.kind !== 'posed' || (result.from === 'film' && !hasLed(result))) return null;
  const candidate = result.candidates[result.chosen];
  if (!candidate || (candidate.residual === null && result.from !== 'file')) return null;
  const isCurrent = result.from !== 'outline' || (resultOf === outline && result.origin === key);
  return isCurrent ? candidate : null;
}

/**
 * How far two poses may lie apart: where the model's middle is, aside and in depth, mm, and the turn that leads from one to the other,
 * degrees. Of the six numbers two poses that lie together may differ by much, as the axes of the model's file have it.
 */
interface Apart {
  readonly aside: number;
  readonly depth: number;
  readonly turn: number;
}

/** Where profiles were read serves for poses this near. Not for others: what is known of a film would depend on the order of work. */
const NEAR: Apart = { aside: 0.2, depth: 2, turn: 0.2 };

/** `middle`: of the model. */
export function isNear(a: PoseNumbers, b: PoseNumbers, middle: Vector): boolean {
  return isWithin(NEAR, a, b, middle);
}

/** Near for whoever has no model at hand: its middle may lie half a metre from its origin, and a turn moves it as far as that says. */
const NEAR_UNSEEN: Apart = { ...NEAR, turn: 0.02 };

export function isNearUnseen(a: PoseNumbers, b: PoseNumbers): boolean {
  return isWithin(NEAR_UNSEEN, a, b, [0, 0, 0]);
}

/** Near for a click, which nobody moves by hand: constants of the film that came while it was followed correct it so much at most. */
const CORRECTED_UNSEEN: Apart = { aside: 3, depth: 10, turn: 0.4 };

export function isCorrectedUnseen(a: PoseNumbers, b: PoseNumbers): boolean {
  return isWithin(CORRECTED_UNSEEN, a, b, [0, 0, 0]);
}

/** From poses this near the frame itself leads to the same one: a hand that corrects so much changes nothing that was read from there. */
const REACH: Apart = { aside: 3, depth: 40, turn: 3 };

/** Does a frame lead from both poses to the same one? */
export function isSamePlace(a: PoseNumbers, b: PoseNumbers, middle: Vector): boolean {
  return isWithin(REACH, a, b, middle);
}

function isWithin({ aside, depth, turn }: Apart, a: PoseNumbers, b: PoseNumbers, middle: Vector): boolean {
  const [p, q] = [inCamera(a, middle), inCamera(b, middle)];
  return Math.hypot(p[0] - q[0], p[1] - q[1]) <= aside && Math.abs(p[2] - q[2]) <= depth && turnBetween(a, b) <= turn;
}

/** A constant has changed by more than this part of its standard deviation, */
const MOVED = 0.15;
/** or its standard deviation by this part of itself. */
const SURER = 0.5;

/** Does an estimate change what is known? Poses are corrected by what is new, not by every last digit. */
export function isNews(before: KnownFilm | null, after: KnownFilm | null): boolean {
  if (!before || !after) return before !== after;
  if (JSON.stringify(before.stated) !== JSON.stringify(after.stated)) return true;
  return COMPONENT_NAMES.some((component) => {
    const [then, now] = [before.models[component], after.models[component]];
    if (then?.of !== now?.of || !then || !now) return then !== now && (then === null || now === null || then.of !== now.of);
    return isNewsOf(then.numbers, now.numbers);
  });
}

/**
 * What a pose that stays as it was refined does not know of its film: all of it, or constants that are others by now. The pose itself moves the
 * estimate that it is one witness of, by less than a standard deviation.
 */
export function filmMissed(then: readonly number[] | null, now: readonly number[] | null): 'all' | 'others' | null {
  if (!now) return null;
  if (!then) return 'all';
  const moved = Array.from({ length: CONSTANTS }, (_, at) => Math.abs(movedIn(then, now, at)) > deviationOf(now, at));
  return moved.some(Boolean) ? 'others' : null;
}

/** Of the first the curvature itself is uncertain, of the others their logarithms. */
function movedIn(then: readonly number[], now: readonly number[], at: number): number {
  return at === 0 ? (now[at] ?? 0) - (then[at] ?? 0) : Math.log((now[at] ?? 1) / (then[at] ?? 1));
}

function isNewsOf(then: readonly number[], now: readonly number[]): boolean {
  return Array.from({ length: CONSTANTS }, (_, at) => {
    const [deviation, later] = [deviationOf(then, at), deviationOf(now, at)];
    return Math.abs(movedIn(then, now, at)) > MOVED * deviation || later < (1 - SURER) * deviation || later > (1 + SURER) * deviation;
  }).some(Boolean);
}

function deviationOf(numbers: readonly number[], at: number): number {
  return Math.sqrt(Math.max(0, numbers[CONSTANTS + (CONSTANTS + 1) * at] ?? 0));
}

/** Poses that were found on the frame with other constants than are known now. What a person set, or checked, stays. */
export function needsCorrection(doc: Doc, component: ComponentName, frame: FrameEntry): (Cell & { readonly result: Posed }) | null {
  const cell = cellOf(doc, frame.id, component);
  const { result, outline, resultOf } = cell;
  if (result?.kind !== 'posed' || !result.onFrame || result.from !== 'outline' || resultOf !== outline) return null;
  if (result.origin !== poseKey(doc, component, frame)) return null;
  const film = filmNumbers(doc, component);
  if (!film || sameFilm(result.onFrame.film, film)) return null;
  const isChecked = checkState(cell, markOf(doc, { frameId: frame.id, component })) === 'yes';
  return isChecked ? null : { ...cell, result };
}

/** What remains at the poses that were found on frames by their film, but for one: what is usual there. */
export function misfitsBeside(doc: Doc, { frameId, component }: Place): FilmMisfits {
  const of = (wanted: (place: Place) => boolean) =>
    foundOnFrames(doc).flatMap(({ cell: { result }, ...place }) => {
      const misfit = result?.kind === 'posed' && result.onFrame?.film ? result.candidates[result.chosen]?.judged?.misfit : undefined;
      return misfit !== undefined && wanted(place) ? [misfit] : [];
    });
  return {
    own: of((place) => place.component === component && place.frameId !== frameId),
    others: of((place) => place.component !== component),
  };
}

/** A candidate after its correction: on a known film poses are compared by what they leave there, not by the outline. */
export function corrected(before: Candidate, { pose, residual, deviations, judged }: Pick<Candidate, 'pose' | 'residual' | 'deviations' | 'judged'>): Candidate {
  return { ...before, drawn: null, pose, residual, deviations, judged };
}

/** So many times what another pose leaves rules a pose out, as the core has it. */
const DECISIVE = 1.3;

/** The verdict on a pose that was held against its frame. */
function verdictOnFrame({ judged }: Candidate): Verdict {
  return judged?.verdict ?? UNMET;
}

/** The verdict on corrected poses, the chosen one first: its own, or that another is open or leaves clearly less. */
export function verdictAfter(before: Posed, [first, ...others]: readonly Candidate[]): Verdict | null {
  const own = first ? verdictOnFrame(first) : null;
  const misfit = first?.judged?.misfit ?? 0;
  const least = Math.min(...others.map(({ judged }) => judged?.misfit ?? Infinity));
  if (own?.word === 'good' && DECISIVE * least < misfit) return { word: 'doubtful', because: texts.film.another(misfit, least) };
  const isRival = before.verdict?.word === 'doubtful' && before.candidates[0]?.judged?.verdict.word === 'good';
  return isRival && own?.word === 'good' ? before.verdict : own;
}

/** What a cell's poses are once they are corrected, and what decided between them. */
export type Settled = Pick<Posed, 'candidates' | 'chosen' | 'decided' | 'verdict' | 'reason'>;

/**
 * Corrected poses with `more` that nobody had looked at. One of them that leaves clearly less takes the place of a pose that nobody
 * chose by hand; one that leaves about as much makes it doubtful, until what is around decides.
 */
export function settled(before: Posed, candidates: readonly Candidate[], more: readonly Candidate[]): Settled {
  const { chosen, decided, reason } = before;
  const own = candidates[chosen];
  const [best] = more.toSorted((a, b) => misfitOf(a) - misfitOf(b));
  const rest = candidates.filter((candidate) => candidate !== own);
  const all = { candidates: [...candidates, ...more], chosen };
  // The others came to the same pose.
  if (own && all.candidates.length === 1) return { ...all, decided: true, reason: decided ? reason : null, verdict: verdictOnFrame(own) };
  if (!own || !best?.judged || misfitOf(best) > DECISIVE * misfitOf(own)) {
    // Between several poses something else decided, which still holds.
    const why = own?.judged && best && candidates.length === 1 ? texts.film.clearer(misfitOf(own), misfitOf(best)) : reason;
    return { ...all, decided, reason: why, verdict: own ? verdictAfter(before, [own, ...rest]) : before.verdict };
  }
  if (chosen !== 0 || DECISIVE * misfitOf(best) > misfitOf(own)) {
    const alone = verdictOnFrame(own);
    const verdict: Verdict = alone.word === 'good' ? { word: 'doubtful', because: texts.film.alike(misfitOf(own), misfitOf(best)) } : alone;
    return { ...all, decided: false, reason: texts.film.undecided(misfitOf(candidates[0] ?? own), misfitOf(best)), verdict };
  }
  const others = [...candidates, ...more.filter((candidate) => candidate !== best)];
  const verdict = verdictAfter({ ...before, verdict: null }, [best, ...others]);
  return { candidates: [best, ...others], chosen, decided, reason: texts.film.clearer(misfitOf(best), misfitOf(own)), verdict };
}

function misfitOf({ judged }: Candidate): number {
  return judged?.misfit ?? Infinity;
}
