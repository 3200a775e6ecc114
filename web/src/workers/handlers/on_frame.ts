import { FilmStudy, type FrameImage, HiddenPixels, type Matcher, Traced } from '../../pkg/core/fluoropose_wasm.js';
import type { ComponentName } from '../../terms/component';
import type { OnFrame } from '../protocol/by_hand';
import type { CameraInput } from '../protocol/camera';
import type { FilmMisfits } from '../protocol/film';
import { poseArray } from '../protocol/pose_array';
import { imageOf } from './frame_pixels';

export type MatcherOf = (component: ComponentName) => Promise<Matcher>;

/** Calls `work` with a frame, and with the pixels of it that belong to the other components. */
export async function onFrame<T>(
  matcherOf: MatcherOf,
  { component, camera, frame, others, unknown }: OnFrame,
  work: (matcher: Matcher, image: FrameImage, hidden: HiddenPixels) => T,
): Promise<T> {
  const matcher = await matcherOf(component);
  const image = imageOf(frame);
  const hidden = new HiddenPixels(camera.text, camera.width, camera.height);
  try {
    for (const other of others) hidden.add(await matcherOf(other.component), Float64Array.from(poseArray(other.pose)));
    if (unknown) hideUnknown(hidden, camera, unknown);
    return work(matcher, image, hidden);
  } finally {
    hidden.free();
    image.free();
  }
}

function hideUnknown(hidden: HiddenPixels, camera: CameraInput, { outline, unknownSides }: NonNullable<OnFrame['unknown']>): void {
  const traced = new Traced(outline, unknownSides, camera.text, camera.width, camera.height);
  try {
    hidden.addUnknown(traced);
  } finally {
    traced.free();
  }
}

/** What the film makes of a component, as WASM takes it. */
export function filmArray(film: readonly number[] | null): Float64Array {
  return Float64Array.from(film ?? []);
}

/** From where on what remains at a pose is unusual on its film, px; nothing where other poses do not tell. */
export function usualMisfit({ own, others }: FilmMisfits): number | undefined {
  return FilmStudy.usualMisfit(Float64Array.from(own), Float64Array.from(others));
}
