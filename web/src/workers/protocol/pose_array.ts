import type { PoseNumbers } from '../../geometry/pose_numbers';

/** Poses as the six numbers in which they cross into WASM: mm, then degrees. */
export function poseArray(pose: PoseNumbers): number[] {
  return [pose.x, pose.y, pose.z, pose.zRot, pose.xRot, pose.yRot];
}

export function poseFrom(values: ArrayLike<number>): PoseNumbers {
  const [x = 0, y = 0, z = 0, zRot = 0, xRot = 0, yRot = 0] = Array.from(values);
  return { x, y, z, zRot, xRot, yRot };
}
