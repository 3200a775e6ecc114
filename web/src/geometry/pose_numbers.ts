/** A pose in the field's Z-X-Y order: millimetres and degrees. */
export interface PoseNumbers {
  readonly x: number;
  readonly y: number;
  readonly z: number;
  readonly zRot: number;
  readonly xRot: number;
  readonly yRot: number;
}

export type Locks = Readonly<Record<keyof PoseNumbers, boolean>>;

export const NO_LOCKS: Locks = { x: false, y: false, z: false, zRot: false, xRot: false, yRot: false };
