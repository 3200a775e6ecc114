/** A pose in the field's Z-X-Y order: millimetres and degrees. */
export interface PoseNumbers {
  readonly x: number;
  readonly y: number;
  readonly z: number;
  readonly zRot: number;
  readonly xRot: number;
  readonly yRot: number;
}

/**
 * How uncertain a pose is: one standard deviation of each of its numbers and, where it is known, the covariance that they come
 * from: the upper half, row by row, as the core has it; and what of it is the film's (not in older sessions).
 */
export interface Uncertainty extends PoseNumbers {
  readonly covariance?: readonly number[];
}

export type Locks = Readonly<Record<keyof PoseNumbers, boolean>>;

export const NO_LOCKS: Locks = { x: false, y: false, z: false, zRot: false, xRot: false, yRot: false };
