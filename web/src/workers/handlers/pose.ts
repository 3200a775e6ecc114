import { calibrationText, cameraDoubts, checkLibrary, choosePose, componentByShape, flangeSide, Matcher, modelRemarks, offTheWay, shapeAxes, Undistorter, Surroundings as RawSurroundings, Traced, type Match as RawMatch } from '../../pkg/core/fluoropose_wasm.js';
import type { Judged, Told, Verdict } from '../../document/types';
import { directionsFrom, numbersOf } from '../../geometry/axes';
import { COMPONENT_NAMES, type ComponentName } from '../../terms/component';
import { poseArray, poseFrom, posesArray, uncertaintyArray, uncertaintyFrom } from '../protocol/pose_array';
import type { ConvergenceStep, PoseProtocol } from '../protocol/pose';
import type { Match, MatchedCandidate, MatchInput, Picture, Refined, Surroundings } from '../protocol/match';
import type { DistortionInput } from '../protocol/camera';
import { byHand } from './by_hand';
import { joint } from './joint';
import { onFilm } from './on_film';
import { oneClick } from './one_click';
import { loadCore } from './core_module';
import { serve } from './serve';

/** Holds both components' libraries and finds poses in them. */
const ready = loadCore();
const matchers = new Map<ComponentName, Matcher>();

serve<PoseProtocol>({
  ...byHand({ withTraced, matcherOf, withSurroundings }),
  ...onFilm({ matcherOf, read }),
  ...joint(ready),
  ...oneClick({ ready, matcherOf, withSurroundings, read }),
  open: async ({ component, bytes, mesh }) => {
    await ready;
    // First: memory of WebAssembly never shrinks, and two at a time need more than one ever does.
    matchers.get(component)?.free();
    matchers.delete(component);
    const matcher = new Matcher(bytes);
    if (mesh) matcher.takeModel(mesh.vertices, mesh.triangles);
    matchers.set(component, matcher);
    return { views: matcher.views, bytes: bytes.length };
  },
  check: async ({ library }) => {
    await ready;
    checkLibrary(library);
    return null;
  },
  library: async ({ component }) => (await matcherOf(component)).bytes as Uint8Array<ArrayBuffer>,
  shape: async ({ mesh }) => {
    await ready;
    const told = componentByShape(mesh.vertices, mesh.triangles);
    return { component: COMPONENT_NAMES.find((component) => component === told) ?? null, remarks: modelRemarks(mesh.vertices, mesh.triangles) };
  },
  calibrationText: async ({ text }) => {
    await ready;
    return calibrationText(text);
  },
  offTheWay: async ({ poses }) => {
    await ready;
    return offTheWay(posesArray(poses)) as (string | null)[];
  },
  cameraDoubts: async ({ text, width, height, stated }) => {
    await ready;
    const { sourceToDetector = null, detectorSpacing = null } = stated ?? {};
    return cameraDoubts(text, width, height, sourceToDetector ?? undefined, detectorSpacing ? Float64Array.from(detectorSpacing) : undefined);
  },
  axes: async ({ component, mesh }) => {
    await ready;
    const found = shapeAxes(mesh.vertices, mesh.triangles, component === 'femur');
    const axes = { directions: directionsFrom(found.directions), told: found.told as Told };
    found.free();
    return axes;
  },
  flangeSide: async ({ mesh, axes }) => {
    await ready;
    const told = flangeSide(mesh.vertices, mesh.triangles, numbersOf(axes));
    return (['left', 'right'] as const).find((side) => side === told) ?? null;
  },
  match: ({ before, ...input }) =>
    withTraced(input, (matcher, traced) => found(matcher, () => followed(matcher, traced, before) ?? matcher.matchOutline(traced))),
  refine: ({ around, ...input }) =>
    withTraced(input, (matcher, traced) =>
      withSurroundings(input.component, around, (raw) => found(matcher, () => matcher.refineOutline(traced, raw))),
    ),
  converge: ({ start, ...input }) =>
    withTraced(input, (matcher, traced) => stepsOf(matcher.convergence(traced, Float64Array.from(poseArray(start))))),
  choose: async ({ component, candidates, middle, around }) => {
    await ready;
    const { poses, residuals } = flattened(candidates);
    const uncertainties = Float64Array.from(candidates.flatMap(({ deviations }) => uncertaintyArray(deviations)));
    const chosen = withSurroundings(component, around, (raw) => choosePose(poses, residuals, uncertainties, Float64Array.from(middle ?? []), raw));
    if (!chosen) return null;
    const { index, decided, sentence: reason, doubt = null } = chosen;
    chosen.free();
    return { index, decided, reason, doubt };
  },
});

async function matcherOf(component: ComponentName): Promise<Matcher> {
  await ready;
  const matcher = matchers.get(component);
  if (!matcher) throw new Error(`The library of the ${component} is not open`);
  return matcher;
}

let undistorter: { readonly key: string; readonly tool: Undistorter } | null = null;

/** Outlines of frames that are shown as they were taken: their points are undistorted before they are looked at. */
function undistorted({ key, numbers }: DistortionInput, outline: Float64Array): Float64Array {
  if (undistorter?.key !== key) {
    undistorter?.tool.free();
    undistorter = { key, tool: new Undistorter(numbers) };
  }
  return undistorter.tool.undistorted(outline);
}

async function withTraced<T>(input: MatchInput, work: (matcher: Matcher, traced: Traced) => T): Promise<T> {
  const { component, outline, unknownSides, laidBy, camera } = input;
  const matcher = await matcherOf(component);
  const points = camera.distortion ? undistorted(camera.distortion, outline) : outline;
  const traced = new Traced(points, unknownSides, camera.text, camera.width, camera.height);
  try {
    if (laidBy) traced.laidBy(laidBy);
    return work(matcher, traced);
  } finally {
    traced.free();
  }
}

function withSurroundings<T>(component: ComponentName, around: Surroundings, work: (raw: RawSurroundings) => T): T {
  const raw = new RawSurroundings();
  try {
    const { counterpart, neighbours } = around;
    if (counterpart) {
      const pose = Float64Array.from(poseArray(counterpart.pose));
      const axes = numbersOf(counterpart.axes);
      raw.setAxes(numbersOf(counterpart.own));
      component === 'tibia' ? raw.setFemur(pose, axes) : raw.setTibia(pose, axes);
    }
    for (const pose of neighbours) raw.addNeighbour(Float64Array.from(poseArray(pose)));
    return work(raw);
  } finally {
    raw.free();
  }
}

function flattened(refined: readonly Refined[]): { poses: Float64Array; residuals: Float64Array } {
  return {
    poses: Float64Array.from(refined.flatMap(({ pose }) => poseArray(pose))),
    residuals: Float64Array.from(refined, ({ residual }) => residual),
  };
}

function followed(matcher: Matcher, traced: Traced, before: readonly Refined[]): RawMatch | undefined {
  if (before.length === 0) return undefined;
  const { poses, residuals } = flattened(before);
  return matcher.follow(traced, poses, residuals);
}

function found(matcher: Matcher, find: () => RawMatch): Match {
  const startedAt = performance.now();
  return read(find(), matcher, performance.now() - startedAt);
}

function read(match: RawMatch, matcher: Matcher, milliseconds: number): Match {
  try {
    return copied(match, matcher, milliseconds);
  } finally {
    match.free();
  }
}

function copied(found: RawMatch, matcher: Matcher, milliseconds: number): Match {
  const { canonicalSize, canonicalArea } = matcher;
  const { clipped, partial, reason = null, decided, verdict: word, because } = found;
  const refusal = word === 'none' ? (because ?? null) : null;
  const candidates = Array.from({ length: found.count }, (_, index) => candidateOf(found, index, canonicalSize));
  const verdict = verdictFrom(word, because);
  return { candidates, canonicalSize, canonicalArea, clipped, partial, reason, decided, verdict, refusal, milliseconds };
}

function candidateOf(found: RawMatch, index: number, size: number): MatchedCandidate {
  const start = found.start(index);
  return {
    pose: poseFrom(found.pose(index) ?? []),
    unmatched: found.unmatched(index) ?? null,
    drawn: found.drawn(index) ?? null,
    residual: found.residual(index) ?? null,
    deviations: uncertaintyFrom(found.uncertainty(index)),
    judged: judgedOf(found, index),
    start: start ? poseFrom(start) : null,
    atBorder: found.atBorder(index) ?? false,
    picture: pictureOf(found, index, size),
  };
}

function judgedOf(found: RawMatch, index: number): Judged | null {
  const misfit = found.misfit(index);
  const verdict = verdictFrom(found.verdictOf(index), found.becauseOf(index));
  return misfit === undefined || !verdict ? null : { misfit, verdict };
}

function verdictFrom(word: string | undefined, because: string | undefined): Verdict | null {
  return (word === 'good' || word === 'doubtful') && because !== undefined ? { word, because } : null;
}

function pictureOf(found: RawMatch, index: number, size: number): Picture | null {
  const [input, view] = [found.inputBits(index), found.viewBits(index)] as (Uint8Array<ArrayBuffer> | undefined)[];
  return input?.length && view?.length ? { size, input, view } : null;
}

/** Numbers of a step of convergence. */
const STEP = 10;

function stepsOf(numbers: Float64Array): ConvergenceStep[] {
  return Array.from({ length: numbers.length / STEP }, (_, at) => {
    const [stage = 0, renders = 0, loss = 0, residual = 0, ...pose] = numbers.subarray(STEP * at, STEP * (at + 1));
    return { stage, renders, loss, residual, pose: poseFrom(pose) };
  });
}
