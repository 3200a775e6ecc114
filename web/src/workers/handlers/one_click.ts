import { OneClick, type FrameImage, type Match as RawMatch, type Matcher, type OneClickAnswer, type Surroundings as RawSurroundings } from '../../pkg/core/fluoropose_wasm.js';
import { numbersOf } from '../../geometry/axes';
import { type ComponentName, otherThan } from '../../terms/component';
import type { OneClickFacts, OneClickInput, OneClickProtocol, OtherInFrame } from '../protocol/one_click';
import type { Match, Surroundings } from '../protocol/match';
import { poseArray } from '../protocol/pose_array';
import { imageOf } from './frame_pixels';
import { filmArray, usualMisfit } from './on_frame';
import type { Context, Handlers } from './serve';

/** What the handler shares with those that hold the libraries. */
export interface Held {
  readonly ready: Promise<unknown>;
  readonly matcherOf: (component: ComponentName) => Promise<Matcher>;
  readonly withSurroundings: <T>(component: ComponentName, around: Surroundings, work: (raw: RawSurroundings) => T) => T;
  readonly read: (match: RawMatch, matcher: Matcher, milliseconds: number) => Match;
}

/** In steps of some tens of milliseconds, so that it can be called off between them. */
export function oneClick(held: Held): Handlers<OneClickProtocol> {
  return {
    oneClick: async (input, context) => {
      await held.ready;
      const matcher = input.withModel ? await held.matcherOf(input.component) : null;
      const other = matcher && input.other ? await held.matcherOf(otherThan(input.component)) : null;
      const image = imageOf(input.frame);
      try {
        return await search(held, input, image, { matcher, other }, context);
      } finally {
        image.free();
      }
    },
  };
}

type Progress = Context<OneClickProtocol['oneClick']['progress']>;

/** Of the component, and of the joint's other one where that is known. */
interface Matchers {
  readonly matcher: Matcher | null;
  readonly other: Matcher | null;
}

async function search(held: Held, input: OneClickInput, image: FrameImage, { matcher, other }: Matchers, context: Progress): Promise<OneClickFacts> {
  const startedAt = performance.now();
  const work = new OneClick(image, input.camera.text, input.prompt, input.bright ?? undefined);
  try {
    if (input.avoid) work.avoid(input.avoid);
    work.knowFilm(filmArray(input.film), usualMisfit(input.misfits));
    if (other && input.other) knowOther(work, other, input.component, input.other);
    if (matcher && input.pose) work.takePose(matcher, Float64Array.from(poseArray(input.pose)));
    else while (matcher ? work.step(matcher) : work.stepAlone()) {
      context.report({ fraction: work.progress, doing: work.doing });
      await context.breathe();
    }
    const answer = matcher
      ? held.withSurroundings(input.component, input.around, (raw) => work.finish(matcher, raw))
      : work.finishAlone();
    return { ...facts(held, answer, matcher, performance.now() - startedAt), bright: work.brightImplant };
  } finally {
    work.free();
  }
}

function knowOther(work: OneClick, other: Matcher, component: ComponentName, { pose, axes, own }: OtherInFrame): void {
  const directions = Float64Array.of(...numbersOf(own.directions), ...numbersOf(axes.directions));
  const fronts = Uint8Array.of(Number(own.front), Number(axes.front));
  work.knowOther(other, Float64Array.from(poseArray(pose)), component === 'femur', directions, fronts);
}

function facts(held: Held, answer: OneClickAnswer, matcher: Matcher | null, milliseconds: number): Omit<OneClickFacts, 'bright'> {
  try {
    const outlines = Array.from({ length: answer.count }, (_, index) => answer.outline(index) as Float64Array<ArrayBuffer> | undefined);
    const match = answer.fromModel && matcher ? answer.takeMatch() : undefined;
    return {
      outlines: outlines.filter((outline) => outline !== undefined),
      supports: outlines.flatMap((_, index) => answer.support(index) ?? []),
      corrected: answer.corrected,
      match: match && matcher ? held.read(match, matcher, milliseconds) : null,
      sentence: answer.sentence,
    };
  } finally {
    answer.free();
  }
}
