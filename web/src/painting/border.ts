import type { Model } from '../pkg/page/fluoropose_page.js';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { CameraInput } from '../workers/protocol/camera';
import { poseArray } from '../workers/protocol/pose_array';

/** Moves a border to where it lies on a frame as it was taken. */
interface Distorter {
  border(model: Model): void;
}

/** Follows the border of a model's silhouette at a pose. The model holds it until it is asked for another. */
export function followBorder(model: Model, { text, width, height }: CameraInput, pose: PoseNumbers, distorter: Distorter | null): void {
  model.project(text, width, height, Float64Array.from(poseArray(pose)));
  model.followBorder(width, height);
  distorter?.border(model);
}
