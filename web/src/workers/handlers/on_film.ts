import type { FrameImage, HiddenPixels, Match as RawMatch, Matcher } from '../../pkg/core/fluoropose_wasm.js';
import type { Match } from '../protocol/match';
import { poseArray } from '../protocol/pose_array';
import type { Corrected, OnFilmProtocol, Uncorrected } from '../protocol/film';
import { filmArray, type MatcherOf, onFrame, usualMisfit } from './on_frame';
import type { Handlers } from './serve';

/** What the handlers share with those that hold the libraries. */
export interface Held {
  readonly matcherOf: MatcherOf;
  readonly read: (match: RawMatch, matcher: Matcher, milliseconds: number) => Match;
}

export function onFilm({ matcherOf, read }: Held): Handlers<OnFilmProtocol> {
  return {
    filmProfiles: ({ pose, ...input }) =>
      onFrame(matcherOf, input, (matcher, image, hidden) => matcher.filmProfiles(image, hidden, Float64Array.from(poseArray(pose))) as Float32Array<ArrayBuffer>),
    correct: ({ candidates, ...input }) =>
      onFrame(matcherOf, input, (matcher, image, hidden) => candidates.map((one) => corrected(matcher, image, hidden, one, filmArray(input.film), read))),
  };
}

function corrected(matcher: Matcher, image: FrameImage, hidden: HiddenPixels, one: Uncorrected, film: Float64Array, read: Held['read']): Corrected | null {
  const usual = one.misfits ? usualMisfit(one.misfits) : undefined;
  try {
    const answer = matcher.correctOnFrame(image, hidden, Float64Array.from(poseArray(one.pose)), one.support ?? 1, film, usual);
    const outline = answer.outline(0) as Float64Array<ArrayBuffer>;
    const match = answer.takeMatch();
    answer.free();
    const candidate = match && read(match, matcher, 0).candidates[0];
    if (!candidate) return null;
    const { pose, residual, deviations, judged } = candidate;
    return { pose, residual, deviations, judged, outline };
  } catch (error) {
    // A trap is none of the core's sentences.
    if (error instanceof WebAssembly.RuntimeError) throw error;
    return null;
  }
}
