import type { EdgeReadings, HandFit, HandVerdict, Landscape, Matcher, Surroundings as RawSurroundings, Traced } from '../../pkg/core/fluoropose_wasm.js';
import type { Verdict } from '../../document/types';
import type { AroundHand, EdgeFacts, FitFacts, GridAxis, HandProtocol, LandscapeFacts, Minimum } from '../protocol/by_hand';
import { poseArray, poseFrom, uncertaintyFrom } from '../protocol/pose_array';
import type { MatchInput, Surroundings } from '../protocol/match';
import type { ComponentName } from '../../terms/component';
import { filmArray, type MatcherOf, onFrame } from './on_frame';
import type { Handlers } from './serve';

/** What the handlers share with those that hold the libraries. */
export interface Held {
  readonly withTraced: <T>(input: MatchInput, work: (matcher: Matcher, traced: Traced) => T) => Promise<T>;
  readonly matcherOf: MatcherOf;
  readonly withSurroundings: <T>(component: ComponentName, around: Surroundings, work: (raw: RawSurroundings) => T) => T;
}

export function byHand({ withTraced, matcherOf, withSurroundings }: Held): Handlers<HandProtocol> {
  const held = <T>(component: ComponentName, around: AroundHand, work: (raw: RawSurroundings) => T): T =>
    withSurroundings(component, around, (raw) => {
      for (const rival of around.rivals) raw.addRival(numbers(poseArray(rival)));
      return work(raw);
    });
  return {
    refineFrom: ({ start, locked, around, ...input }) =>
      withTraced(input, (matcher, traced) => held(input.component, around, (raw) => factsOf(matcher.refineFrom(traced, numbers(poseArray(start)), flags(locked), raw)))),
    refineOnFrame: ({ start, locked, around, ...input }) =>
      onFrame(matcherOf, input, (matcher, image, hidden) =>
        held(input.component, around, (raw) =>
          factsOf(matcher.refineOnFrame(image, hidden, numbers(poseArray(start)), flags(locked), filmArray(input.film), input.bright, raw)),
        ),
      ),
    judgeOutline: ({ pose, around, ...input }) =>
      withTraced(input, (matcher, traced) => held(input.component, around, (raw) => verdictOf(matcher.judgeOutline(traced, numbers(poseArray(pose)), raw)))),
    judgeOnFrame: ({ pose, around, ...input }) =>
      onFrame(matcherOf, input, (matcher, image, hidden) =>
        held(input.component, around, (raw) => verdictOf(matcher.judgeOnFrame(image, hidden, numbers(poseArray(pose)), filmArray(input.film), input.bright, raw))),
      ),
    readOnFrame: ({ pose, ...input }) =>
      onFrame(matcherOf, input, (matcher, image, hidden) => edgesOf(matcher.readOnFrame(image, hidden, numbers(poseArray(pose)), filmArray(input.film), input.bright))),
    landscape: (input) => withTraced(input, (matcher, traced) => landscapeOf(matcher.landscape(traced))),
    viewPose: ({ view, ...input }) =>
      withTraced(input, (matcher, traced) => {
        const found = matcher.viewPose(traced, view);
        const { unmatched } = found;
        const pose = poseFrom(found.pose);
        found.free();
        return { pose, unmatched };
      }),
  };
}

function factsOf(fit: HandFit): FitFacts {
  const { residual, drawn = null, bright } = fit;
  const deviations = uncertaintyFrom(fit.uncertainty);
  const pose = poseFrom(fit.pose);
  const verdict = verdictOf(fit.verdict);
  fit.free();
  return { pose, residual, drawn, deviations, bright, verdict };
}

function verdictOf(raw: HandVerdict): Verdict {
  const { word, because } = raw;
  raw.free();
  return { word: word === 'good' ? 'good' : 'doubtful', because };
}

function edgesOf(readings: EdgeReadings): EdgeFacts {
  const { met, known, residual } = readings;
  const numbers = readings.numbers as Float32Array<ArrayBuffer>;
  readings.free();
  return { numbers, met, known, residual };
}

function landscapeOf(landscape: Landscape): LandscapeFacts {
  const [x0 = 0, xStep = 1, xCount = 0, y0 = 0, yStep = 1, yCount = 0] = landscape.axes;
  const axis = (first: number, step: number, count: number): GridAxis => ({ first, step, count });
  const scores = landscape.scores as Uint32Array<ArrayBuffer>;
  const minima = triples(landscape.minima).map(([x, y, unmatched]): Minimum => ({ x, y, unmatched }));
  landscape.free();
  return { x: axis(x0, xStep, xCount), y: axis(y0, yStep, yCount), scores, minima };
}

function triples(values: Float64Array): [number, number, number][] {
  return Array.from({ length: values.length / 3 }, (_, at) => {
    const [a = 0, b = 0, c = 0] = values.subarray(3 * at, 3 * at + 3);
    return [a, b, c];
  });
}

function numbers(values: readonly number[]): Float64Array {
  return Float64Array.from(values);
}

function flags(values: readonly boolean[]): Uint8Array {
  return Uint8Array.from(values, Number);
}
