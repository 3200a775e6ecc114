import { FilmFollower, FilmReader, type FollowedFilm } from '../../pkg/core/fluoropose_wasm.js';
import { numbersOf } from '../../geometry/axes';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import { COMPONENT_NAMES } from '../../terms/component';
import type { Femurs, FilmReading, FollowedFrame, FollowProtocol, FollowState } from '../protocol/follow';
import { poseArray, poseFrom, posesArray, uncertaintyFrom } from '../protocol/pose_array';
import { loadCore } from './core_module';
import { firstPoses, Searcher } from './first_poses';
import { withImage } from './frame_pixels';
import { serve } from './serve';

/** Follows one component, beside the worker that finds poses: the person goes on working. */
const ready = loadCore();
const NONE = new Float64Array();
let follower: FilmFollower | null = null;
let reader: FilmReader | null = null;
const searcher = new Searcher();
let frames = 0;


serve<FollowProtocol>({
  ...firstPoses(ready, searcher),
  readFilm: async ({ given, justThere, ...film }) => {
    await ready;
    return read(film, (begun) => {
      for (const { frame, pose } of given) {
        const numbers = Float64Array.from(poseArray(pose));
        if (justThere) begun.ask(frame, numbers);
        else begun.give(frame, numbers);
      }
    });
  },
  askFilm: ({ otherMiddles, ...film }) => {
    const asked = rowsOf(working().toAsk(otherMiddles), 7);
    return read(film, (begun) => asked.forEach(([frame, ...pose]) => begun.ask(frame!, Float64Array.from(pose))));
  },
  lookFilm: (pixels) =>
    withImage(pixels, async (image) => {
      if (!reader) throw new Error('no film is read');
      const profiles = reader.take(image) as Float32Array<ArrayBuffer>;
      return { profiles, next: reader.wanted() ?? null };
    }),
  begin: async ({ mesh, camera, first, last, given, film, searches, ...input }) => {
    await ready;
    follower?.free();
    follower = null;
    frames = input.frames;
    const { text, width, height } = camera;
    const begun = new FilmFollower(mesh.vertices, mesh.triangles, text, width, height, frames, first, last, Float64Array.from(film ?? []));
    for (const { frame, pose, isSet } of given) begun.give(frame, Float64Array.from(poseArray(pose)), isSet);
    if (searches && searcher.isOpen) {
      searcher.knowFilm(Float64Array.from(film ?? []));
      begun.searchWhereLost();
    }
    follower = begun;
    return begun.wanted() ?? null;
  },
  look: (pixels, context) =>
    withImage(pixels, async (image) => {
      if (working().isSearch) {
        const other = posed(working().beside());
        searcher.own().showBright(working().isBright);
        await searcher.find(image, { beside: other && { pose: other, inJoint: true }, places: 'all' }, context);
        working().searched(searcher.pose);
        return { pose: null, isBeside: other !== null, next: working().wanted() ?? null };
      }
      const pose = posed(working().take(image));
      return { pose, isBeside: false, next: working().wanted() ?? null };
    }),
  seeSides: () => {
    working().seeSides();
    return working().wanted() ?? null;
  },
  sides: ({ femurs }) => {
    working().chooseSides(...numbers(femurs));
    return working().wanted() ?? null;
  },
  standsWith: ({ femurs }) => (working().standsWith(...numbers(femurs)) ? null : (working().wanted() ?? null)),
  lookBeside: ({ other, otherMiddles, femurs }) => {
    working().lookBeside(posesArray(other), otherMiddles, ...numbers(femurs));
    return working().wanted() ?? null;
  },
  good: ({ otherMiddles }) => rowsOf(working().good(otherMiddles), 6).map((pose) => (pose.every(Number.isFinite) ? poseFrom(Float64Array.from(pose)) : null)),
  compare: ({ frames }) => {
    working().compareSides(Uint32Array.from(frames));
    return working().wanted() ?? null;
  },
  stop: () => {
    working().stop();
    return null;
  },
  middles: () => working().middles() as Float64Array<ArrayBuffer>,
  conclude: ({ otherMiddles }) => {
    const film = working().conclude(otherMiddles);
    const found = Array.from({ length: frames }, (_, frame): FollowedFrame => ({
      state: (film.state(frame) ?? 'unsolved') as FollowState,
      because: film.because(frame) ?? '',
      pose: posed(film.pose(frame)),
      deviations: uncertaintyFrom(film.uncertainty(frame)),
      residual: film.residual(frame) ?? null,
      badness: film.badness(frame) ?? 0,
      rival: rivalOf(film, frame),
    }));
    film.free();
    return found;
  },
});

function rivalOf(film: FollowedFilm, frame: number): FollowedFrame['rival'] {
  const pose = posed(film.rival(frame));
  return pose && { pose, residual: film.rivalResidual(frame) ?? null };
}

function working(): FilmFollower {
  if (!follower) throw new Error('nothing is followed');
  return follower;
}

function posed(numbers: Float64Array | undefined): PoseNumbers | null {
  return numbers ? poseFrom(numbers) : null;
}

function numbers(femurs: Femurs | null): readonly [Float64Array, Float64Array, Float64Array] {
  if (!femurs) return [NONE, NONE, NONE];
  const { poses, axes, own } = femurs;
  return [posesArray(poses), numbersOf(axes), numbersOf(own)];
}

/** Numbers in rows of so many. */
function rowsOf(numbers: Float64Array, count: number): readonly (readonly number[])[] {
  return Array.from({ length: numbers.length / count }, (_, row) => [...numbers.subarray(count * row, count * (row + 1))]);
}

/** Begins to read profiles of the film; gives the first frame that is wanted. */
function read({ mesh, camera: { text, width, height }, component, frames, side }: Omit<FilmReading, 'given' | 'justThere'>, ask: (begun: FilmReader) => void): number | null {
  reader?.free();
  reader = null;
  const begun = new FilmReader(mesh.vertices, mesh.triangles, text, width, height, frames, COMPONENT_NAMES.indexOf(component), side);
  ask(begun);
  reader = begun;
  return begun.wanted() ?? null;
}
