import type { FrameImage, HiddenPixels, Match as RawMatch, Matcher } from '../../pkg/core/fluoropose_wasm.js';
import type { Match } from '../protocol/match';
import { poseArray } from '../protocol/pose_array';
import type { Corrected, OnFilmProtocol } from '../protocol/film';
import { filmArray, type MatcherOf, onFrame, usualMisfit } from './on_frame';
import type { Handlers } from './serve';

/** What the handlers share with those that hold the libraries. */
export interface Held {
  readonly matcherOf: MatcherOf;
  readonly read: (match: RawMatch, matcher: Matcher, milliseconds: number) => Match;
}

export function onFilm({ matcherOf, read }: Held): Handlers<OnFilmProtocol> {
  return {
    filmProfiles: ({ pose, side, ...input }) =>
      onFrame(matcherOf, input, (matcher, image, hidden) => matcher.filmProfiles(image, hidden, Float64Array.from(poseArray(pose)), side) as Float32Array<ArrayBuffer>),
    correct: (input) =>
      onFrame(matcherOf, input, (matcher, image, hidden) => {
        try {
          return corrected(matcher, image, hidden, input, read);
        } catch (error) {
          // A trap is none of the core's sentences.
          if (error instanceof WebAssembly.RuntimeError) throw error;
          return [];
        }
      }),
  };
}

type Input = OnFilmProtocol['correct']['input'];

function corrected(matcher: Matcher, image: FrameImage, hidden: HiddenPixels, { candidates, chosen, misfits, film }: Input, read: Held['read']): readonly Corrected[] {
  const poses = Float64Array.from(candidates.flatMap(({ pose }) => poseArray(pose)));
  const supports = Float64Array.from(candidates, ({ support }) => support ?? 1);
  const answer = matcher.correctOnFrame(image, hidden, poses, supports, chosen, filmArray(film), usualMisfit(misfits));
  try {
    const match = answer.takeMatch();
    const found = match ? read(match, matcher, 0).candidates : [];
    return found.map(({ pose, residual, deviations, judged }, index) => ({
      from: answer.from(index) ?? null,
      pose,
      residual,
      deviations,
      judged,
      support: answer.support(index) ?? 1,
      outline: answer.outline(index) as Float64Array<ArrayBuffer>,
    }));
  } finally {
    answer.free();
  }
}
