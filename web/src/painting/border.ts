import type { Model } from '../pkg/page/fluoropose_page.js';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { CameraInput } from '../workers/protocol/camera';
import { poseArray } from '../workers/protocol/pose_array';

/** Bends a border as its frame was bent when it was taken. */
interface Bent {
  border(model: Model): void;
}

/** Follows the border of a model's silhouette at a pose. The model holds it until it is asked for another. */
export function followBorder(model: Model, { text, width, height }: CameraInput, pose: PoseNumbers, bent: Bent | null): void {
  model.project(text, width, height, Float64Array.from(poseArray(pose)));
  model.followBorder(width, height);
  bent?.border(model);
}
