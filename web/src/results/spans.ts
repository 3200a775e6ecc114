import { isFollowed, isFree } from '../document/followed';
import { checkState, markOf } from '../document/marks';
import { cellOf, chosenCandidate, type Doc, isByHand, verdictOf } from '../document/types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';

/** Frames that a component is to be followed over, from those that a person set. */
export interface Span {
  readonly first: number;
  readonly last: number;
  /** Frames in it that nobody set. */
  readonly free: number;
  readonly given: readonly Given[];
  /** All of them are doubtful, and so is what they lead to. */
  readonly isDoubtful: boolean;
  /** What a frame is followed from, as text: where that has changed it is followed again. */
  readonly key: (frame: number) => string;
}

export interface Given {
  readonly frame: number;
  readonly pose: PoseNumbers;
  /** It may be wrong, and nobody checked it. */
  readonly isDoubtful: boolean;
  /** It was followed, and somebody found it right as it was. */
  readonly isAccepted: boolean;
}

/** Null where nothing is to be done: no frame is set, or all that lies between is followed from those that are. */
export function spanToFollow(doc: Doc, component: ComponentName): Span | null {
  const given = givenPoses(doc, component);
  if (given.length === 0) return null;
  const key = (frame: number) => keyAmong(given, frame);
  // Frames that were followed together with one that somebody finds right need not be followed again for it.
  const besidesAccepted = given.filter(({ isAccepted }) => !isAccepted);
  const isDoubtful = given.every((one) => one.isDoubtful);
  const set = new Set(given.map(({ frame }) => frame));
  const stale = doc.frames.flatMap(({ id }, frame) => {
    const cell = cellOf(doc, id, component);
    if (set.has(frame) || !isFree(cell)) return [];
    const isFrom = (these: readonly Given[]) => isFollowed(cell.result) && cell.result?.origin.endsWith(keyAmong(these, frame));
    // Sessions from before `own` do not know what is said of it now.
    const isLed = !isDoubtful && verdictOf(cell.result)?.because === texts.follow.fromDoubtful;
    const isDone = !isLed && (isFrom(given) || (besidesAccepted.length > 0 && isFrom(besidesAccepted)));
    return isDone ? [] : [frame];
  });
  const [from, to] = [stale[0], stale.at(-1)];
  if (from === undefined || to === undefined) return null;
  const first = given.filter((one) => one.frame < from).at(-1)?.frame ?? 0;
  const last = given.find((one) => one.frame > to)?.frame ?? doc.frames.length - 1;
  const inside = given.filter(({ frame }) => frame >= first && frame <= last);
  return { first, last, free: stale.length, given: inside, isDoubtful, key };
}

/** Is what a frame was followed from doubtful? Null where it would be followed from others now. */
export function isLeadDoubtful(doc: Doc, component: ComponentName): (frame: number, origin: string) => boolean | null {
  const given = givenPoses(doc, component);
  const isDoubtful = given.every((one) => one.isDoubtful);
  return (frame, origin) => (given.length > 0 && origin.endsWith(keyAmong(given, frame)) ? isDoubtful : null);
}

/** Poses that a person set, traced, opened or checked. Those of a doubtful outline lead only where there is nothing better. */
function givenPoses(doc: Doc, component: ComponentName): readonly Given[] {
  const all = doc.frames.flatMap(({ id }, frame) => {
    const cell = cellOf(doc, id, component);
    const isChecked = checkState(cell, markOf(doc, { frameId: id, component })) === 'yes';
    const pose = chosenCandidate(cell)?.pose;
    const isDoubtful = !isChecked && !isByHand(cell.result) && verdictOf(cell.result)?.word === 'doubtful';
    return pose && (!isFollowed(cell.result) || isChecked) ? [{ frame, pose, isDoubtful, isAccepted: isFollowed(cell.result) }] : [];
  });
  const trusted = all.filter(({ isDoubtful }) => !isDoubtful);
  return trusted.length > 0 ? trusted : all;
}

function keyAmong(given: readonly Given[], frame: number): string {
  const next = firstFrom(given, frame);
  const after = given[next];
  const before = after?.frame === frame ? after : given[next - 1];
  return [before, after].flatMap((one) => (one ? [keyOf(one)] : [])).join(' and ');
}

/** Number of the first that is at a frame or behind it: they are in the order of the film. */
function firstFrom(given: readonly Given[], frame: number): number {
  let [low, high] = [0, given.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (given[middle]!.frame < frame) low = middle + 1;
    else high = middle;
  }
  return low;
}

function keyOf({ frame, pose }: Given): string {
  const { x, y, z, zRot, xRot, yRot } = pose;
  return `frame ${frame + 1} at ${[x, y, z, zRot, xRot, yRot].map((number) => number.toFixed(3)).join(' ')}`;
}
