import type { PoseNumbers, Uncertainty } from '../../geometry/pose_numbers';

/** Poses as the six numbers in which they cross into WASM: mm, then degrees. */
export function poseArray(pose: PoseNumbers): number[] {
  return [pose.x, pose.y, pose.z, pose.zRot, pose.xRot, pose.yRot];
}

export function poseFrom(values: ArrayLike<number>): PoseNumbers {
  const [x = 0, y = 0, z = 0, zRot = 0, xRot = 0, yRot = 0] = Array.from(values);
  return { x, y, z, zRot, xRot, yRot };
}

/** As many numbers that say that there is no pose. */
export const NO_POSE: readonly number[] = Array<number>(6).fill(NaN);

/** The poses of a film, frame by frame. */
export function posesArray(poses: readonly (PoseNumbers | null)[]): Float64Array {
  return Float64Array.from(poses.flatMap((pose) => (pose ? poseArray(pose) : NO_POSE)));
}

/** Numbers of a pose's uncertainty on the same way: six standard deviations, the upper half of a covariance, what of it is the film's. */
const UNCERTAIN = 39;

export function uncertaintyFrom(values: Float64Array | undefined): Uncertainty | null {
  return values ? { ...poseFrom(values), covariance: Array.from(values.subarray(6, UNCERTAIN)) } : null;
}

/** NaN for what is not known. */
export function uncertaintyArray(uncertainty: Uncertainty | null): number[] {
  const known = uncertainty ? [...poseArray(uncertainty), ...(uncertainty.covariance ?? [])] : [];
  return [...known, ...Array<number>(UNCERTAIN - known.length).fill(NaN)];
}
