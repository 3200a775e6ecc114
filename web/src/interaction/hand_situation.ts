import type { Locks, PoseNumbers } from '../geometry/pose_numbers';
import type { Pinhole, Vector } from '../geometry/pose_motion';

/** What a hand on the model needs to know. */
export interface HandSituation {
  /** Where the model is, or where it would be placed. */
  readonly pose: PoseNumbers;
  /** The model is not there yet: the first press places it. */
  readonly absent: boolean;
  /** The middle of the model in its own coordinates, mm. */
  readonly middle: Vector;
  readonly camera: Pinhole;
  readonly locks: Locks;
  /** The mouse moves the model a fifth as far. */
  readonly fine: boolean;
}
