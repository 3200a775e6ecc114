import type { Directions } from '../../geometry/axes';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import type { ModelMesh } from './decode';

/** One component of a joint. Without a model nothing is known of lowest points. */
export interface JointPart {
  readonly mesh: ModelMesh | null;
  readonly axes: Directions;
}

export interface JointModels {
  readonly femur: JointPart;
  readonly tibia: JointPart;
  readonly side: 'left' | 'right';
}

export interface JointFacts {
  /** Names of the numbers of a frame, in their order. */
  readonly columns: readonly string[];
  /** Lowest points and lift-off are known. */
  readonly hasPlate: boolean;
}

/** A pose, and one standard deviation of each of its numbers, where these are known. */
export interface Uncertain {
  readonly pose: PoseNumbers;
  readonly deviations: PoseNumbers | null;
}

export interface JointProtocol {
  /** What the numbers of a joint are taken of, until another one is opened. */
  openJoint: { input: JointModels; output: JointFacts; progress: never };
  /** The numbers of frames, one after another, NaN for what is not known. Throws while no joint is open. */
  joint: { input: readonly { readonly femur: Uncertain; readonly tibia: Uncertain }[]; output: Float64Array<ArrayBuffer>; progress: never };
}
