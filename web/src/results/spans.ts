import type { Place } from '../document/command';
import { hasLed, isFollowed, isFound, isFree, isSoFar } from '../document/followed';
import { checkState, markOf } from '../document/marks';
import { cellOf, chosenCandidate, type Doc, isByHand, verdictAlone } from '../document/types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';
import { isCorrectedUnseen, isNearUnseen } from './film';

/** Frames that a component is to be followed over, from those that a person set. */
export interface Span {
  readonly first: number;
  readonly last: number;
  /** Frames in it that nobody set. */
  readonly free: number;
  readonly given: readonly Given[];
  /** A person set all of them, they are doubtful, and so is what they lead to. */
  readonly isDoubtful: boolean;
  /** What a frame is followed from, as text: where that has changed it is followed again. Of poses that nobody set, as the film left them. */
  readonly key: (frame: number, left?: (frame: number) => PoseNumbers | null) => string;
}

export interface Given {
  readonly frame: number;
  readonly pose: PoseNumbers;
  /** A person set, chose or checked it: it stays. Of others the film tells whether they are right, as of every frame. */
  readonly isSet: boolean;
  /** It may be wrong, and nobody checked it. */
  readonly isDoubtful: boolean;
  /** It was followed, and somebody found it right as it was. */
  readonly isAccepted: boolean;
  /** A click led to it, and the film corrects it. */
  readonly isClicked: boolean;
  /** It led, and the film that was followed from it does not find it right. */
  readonly isRuledOut: boolean;
}

/** Null where nothing is to be done: no frame is set, or all that lies between is followed from those that are. */
export function spanToFollow(doc: Doc, component: ComponentName): Span | null {
  const given = givenPoses(doc, component);
  if (given.length === 0) return null;
  const key: Span['key'] = (frame, left = () => null) => keyAmong(given.map((one) => (one.isSet ? one : { ...one, pose: left(one.frame) ?? one.pose })), frame);
  const isDoubtful = given.every((one) => one.isDoubtful && one.isSet);
  // Of what nobody set the whole film is to tell.
  const isOpen = given.some((one) => one.isDoubtful && !one.isSet);
  const set = new Set(given.map(({ frame }) => frame));
  const stale = doc.frames.flatMap(({ id }, frame) => {
    const cell = cellOf(doc, id, component);
    if (set.has(frame) || !isFree(cell)) return [];
    // What was followed so far when the page went was not judged with the film.
    const isJudged = isFollowed(cell.result) && !isSoFar(cell.result);
    // Sessions from before `own` do not know what is said of it now.
    const isLed = !isDoubtful && verdictAlone(cell.result)?.because === texts.follow.fromDoubtful;
    const isDone = !isOpen && !isLed && isJudged && cell.result !== null && isFollowedWith(cell.result.origin, given, frame);
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
  return (frame, origin) => (given.length > 0 && isFromThese(origin, given, frame) ? isDoubtful : null);
}

/** Is there a pose that others are followed from? */
export function isLed(doc: Doc, component: ComponentName): boolean {
  return givenPoses(doc, component).length > 0;
}

/**
 * Poses that lead: those that a person set, traced, opened or checked, and what the program found, unless somebody set another and the film
 * found it wrong. Doubtful ones lead only where there is nothing better.
 */
function givenPoses(doc: Doc, component: ComponentName): readonly Given[] {
  const all = doc.frames.flatMap(({ id }, frame) => givenIn(doc, { frameId: id, component }, frame) ?? []);
  const isOfPerson = all.some(({ isSet, isDoubtful, isAccepted }) => isSet && !isDoubtful && !isAccepted);
  const leading = isOfPerson ? all.filter((one) => !one.isRuledOut) : all;
  const trusted = leading.filter(({ isDoubtful }) => !isDoubtful);
  const open = leading.filter(({ isSet }) => !isSet);
  return trusted.length > 0 ? trusted : open.length > 0 ? open : leading;
}

function givenIn(doc: Doc, place: Place, frame: number): Given | null {
  const cell = cellOf(doc, place.frameId, place.component);
  const pose = chosenCandidate(cell)?.pose;
  if (!pose) return null;
  const isChecked = checkState(cell, markOf(doc, place)) === 'yes';
  if (isFollowed(cell.result)) {
    const led = hasLed(cell.result);
    const isRuledOut = !isChecked && verdictAlone(cell.result)?.word !== 'good';
    return isChecked || led ? { frame, pose, isSet: isChecked, isDoubtful: false, isAccepted: isChecked && !led, isClicked: false, isRuledOut } : null;
  }
  const isDoubtful = !isChecked && !isByHand(cell.result) && verdictAlone(cell.result)?.word === 'doubtful';
  return { frame, pose, isSet: !isDoubtful || !isFound(cell), isDoubtful, isAccepted: false, isClicked: isFound(cell), isRuledOut: false };
}

function keyAmong(given: readonly Given[], frame: number): string {
  return leadsAmong(given, frame).map(keyOf).join(' and ');
}

/** The nearest on both sides of a frame. */
function leadsAmong(given: readonly Given[], frame: number): readonly Given[] {
  const next = firstFrom(given, frame);
  const after = given[next];
  const before = after?.frame === frame ? after : given[next - 1];
  return [before, after].flatMap((one) => one ?? []);
}

/**
 * Was a frame followed from these? Constants of the film that are a little others move a clicked pose a little, there and back: its own
 * frame leads from both places to the same pose, and so do those beside it.
 */
function isFromThese(origin: string, given: readonly Given[], frame: number): boolean {
  if (origin.endsWith(keyAmong(given, frame))) return true;
  const [led, leads] = [ledBy(origin), leadsAmong(given, frame)];
  return led.length === leads.length && leads.every((lead) => isOneOf(led, lead));
}

/** The same, or was it followed together with what somebody found right as it was? For that it need not be followed again. */
function isFollowedWith(origin: string, given: readonly Given[], frame: number): boolean {
  if (isFromThese(origin, given, frame)) return true;
  const [led, leads] = [ledBy(origin), leadsAmong(given, frame)];
  const isAny = led.length > 0 && leads.some(({ isAccepted }) => isAccepted);
  return isAny && leads.every((lead) => lead.isAccepted || isOneOf(led, lead));
}

function isOneOf(led: readonly Pick<Given, 'frame' | 'pose'>[], { frame, pose, isClicked }: Given): boolean {
  return led.some((one) => one.frame === frame && (isClicked ? isCorrectedUnseen : isNearUnseen)(one.pose, pose));
}

/** What `keyAmong` wrote. */
function ledBy(origin: string): readonly Pick<Given, 'frame' | 'pose'>[] {
  const [, leads = ''] = /^\D*(frame \d+ at [-\d. ]+(?: and frame \d+ at [-\d. ]+)?)$/.exec(origin) ?? [];
  return leads.split(' and ').flatMap((lead) => {
    const [frame, x, y, z, zRot, xRot, yRot] = lead.match(/-?[\d.]+/g)?.map(Number) ?? [];
    return yRot === undefined ? [] : [{ frame: frame! - 1, pose: { x: x!, y: y!, z: z!, zRot: zRot!, xRot: xRot!, yRot } }];
  });
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
