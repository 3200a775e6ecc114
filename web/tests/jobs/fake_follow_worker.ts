import type { PoseNumbers } from '../../src/geometry/pose_numbers';
import type { FilmReading, FollowInput, FollowedFrame } from '../../src/workers/protocol/follow';

export const FRAMES = 6;
/** So far the film moves a pose that nobody set, mm. */
export const MOVED = 0.25;
export const poseOf = (x: number): PoseNumbers => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });

/** A worker that finds the component in every frame but those it is told, ten to the right of the first given pose. */
export function worker(missing: readonly number[]) {
  const asked: string[] = [];
  let again: number | null = null;
  const begun: FollowInput[] = [];
  const beside: (readonly (PoseNumbers | null)[])[] = [];
  let lost: number | null = null;
  let isGoodInFew = false;
  let input: FollowInput | null = null;
  let seen: number[] = [];
  let compared: readonly number[] = [];
  let toRead: number[] = [];
  const read: FilmReading[] = [];
  const rest = () => {
    const { first, last, given } = input!;
    const isOpen = (frame: number) => !seen.includes(frame) && !given.some((one) => one.frame === frame);
    return Array.from({ length: last - first + 1 }, (_, k) => first + k).find(isOpen) ?? null;
  };
  const answer = (frame: number): FollowedFrame => {
    const given = input!.given.find((one) => one.frame === frame);
    const isThere = seen.includes(frame) && !missing.includes(frame);
    const state = given?.isSet ? 'fixed' : given ? 'followed' : isThere ? (frame === 4 ? 'doubtful' : 'followed') : seen.includes(frame) ? 'untrackable' : 'unsolved';
    // What nobody set the film may move.
    const pose = (given && poseOf(given.pose.x + (given.isSet ? 0 : MOVED))) ?? (isThere ? poseOf(10 + frame) : null);
    return { state, because: `as ${state} says`, pose, deviations: null, residual: 0.2, badness: state === 'doubtful' ? 2 : 0, rival: compared.includes(frame) ? { pose: poseOf(-frame), residual: 0.3 } : null };
  };
  const methods: Record<string, (given: never) => unknown> = {
    begin: (given: FollowInput) => {
      begun.push(given);
      [input, seen] = [given, []];
      return rest();
    },
    look: () => {
      const frame = rest() ?? again ?? lost!;
      seen.push(frame);
      return { pose: poseOf(10 + frame), isBeside: false, next: rest() };
    },
    readFilm: (asked: FilmReading) => {
      [toRead] = [framesOf(asked), read.push(asked)];
      return toRead[0]!;
    },
    lookFilm: () => {
      const frame = toRead.shift()!;
      return { profiles: Float32Array.of(frame), next: toRead[0] ?? null };
    },
    seeSides: () => null,
    sides: () => null,
    standsWith: () => again,
    good: () => Array.from({ length: FRAMES }, (_, frame) => answer(frame)).map(({ state, pose }) => (state === 'followed' || state === 'fixed' ? pose : null)),
    lookBeside: (given: { readonly other: readonly (PoseNumbers | null)[] }) => {
      beside.push(given.other);
      return lost;
    },
    askFilm: () => {
      toRead = isGoodInFew ? [] : [0, 2];
      return toRead[0] ?? null;
    },
    stop: () => null,
    compare: ({ frames }: { readonly frames: readonly number[] }) => {
      compared = frames;
      return null;
    },
    middles: () => new Float64Array(3 * FRAMES),
    conclude: () => Array.from({ length: FRAMES }, (_, frame) => answer(frame)),
  };
  let gate: { readonly frame: number; readonly then: () => void } | null = null;
  const call = async (method: string, given: unknown) => {
    const frame = method === 'look' ? rest() : null;
    asked.push(method);
    const answer = methods[method]!(given as never);
    if (gate && frame === gate.frame) gate.then();
    return answer;
  };
  const dispose = () => void asked.push('let go');
  return { begun, beside, asked, read, call, isGoodInFew: () => void (isGoodInFew = true), lose: (frame: number) => void (lost = frame), dispose, doAgain: (frame: number) => void (again = frame), stopAt: (frame: number, then: () => void) => void (gate = { frame, then }) };
}

function framesOf({ given: [first], justThere }: FilmReading): number[] {
  const frames = justThere ? [first!.frame] : [first!.frame, first!.frame + 1];
  return frames.filter((frame) => frame < FRAMES);
}
