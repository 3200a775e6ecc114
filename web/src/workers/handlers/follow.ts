import { FilmFollower } from '../../pkg/core/fluoropose_wasm.js';
import { numbersOf } from '../../geometry/axes';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import type { Femurs, FollowedFrame, FollowProtocol, FollowState } from '../protocol/follow';
import { poseArray, poseFrom } from '../protocol/pose_array';
import { loadCore } from './core_module';
import { imageOf } from './frame_pixels';
import { serve } from './serve';

/** Follows one component, beside the worker that finds poses: the person goes on working. */
const ready = loadCore();
let follower: FilmFollower | null = null;
let frames = 0;

const NO_POSE = [NaN, NaN, NaN, NaN, NaN, NaN];
const NONE = new Float64Array();

serve<FollowProtocol>({
  begin: async ({ mesh, camera, first, last, given, film, ...input }) => {
    await ready;
    follower?.free();
    follower = null;
    frames = input.frames;
    const { text, width, height } = camera;
    const begun = new FilmFollower(mesh.vertices, mesh.triangles, text, width, height, frames, first, last, Float64Array.from(film ?? []));
    for (const { frame, pose } of given) begun.give(frame, Float64Array.from(poseArray(pose)), true);
    follower = begun;
    return begun.wanted() ?? null;
  },
  look: (pixels) => {
    const image = imageOf(pixels);
    try {
      const pose = working().take(image);
      return { pose: pose ? poseFrom(pose) : null, next: working().wanted() ?? null };
    } finally {
      image.free();
    }
  },
  sides: ({ femurs }) => {
    const [poses, axes, own] = femurs ? numbers(femurs) : [NONE, NONE, NONE];
    working().chooseSides(poses, axes, own);
    return working().wanted() ?? null;
  },
  stop: () => {
    working().stop();
    return null;
  },
  depths: () => working().depths() as Float64Array<ArrayBuffer>,
  conclude: ({ otherDepths }) => {
    const film = working().conclude(otherDepths);
    const found = Array.from({ length: frames }, (_, frame): FollowedFrame => ({
      state: (film.state(frame) ?? 'unsolved') as FollowState,
      because: film.because(frame) ?? '',
      pose: posed(film.pose(frame)),
      deviations: posed(film.deviations(frame)),
      residual: film.residual(frame) ?? null,
      badness: film.badness(frame) ?? 0,
    }));
    film.free();
    return found;
  },
});

function working(): FilmFollower {
  if (!follower) throw new Error('nothing is followed');
  return follower;
}

function posed(numbers: Float64Array | undefined): PoseNumbers | null {
  return numbers ? poseFrom(numbers) : null;
}

function numbers({ poses, axes, own }: Femurs): readonly [Float64Array, Float64Array, Float64Array] {
  const all = poses.flatMap((pose) => (pose ? poseArray(pose) : NO_POSE));
  return [Float64Array.from(all), numbersOf(axes), numbersOf(own)];
}
