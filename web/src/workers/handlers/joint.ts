import { KneeJoint } from '../../pkg/core/fluoropose_wasm.js';
import { numbersOf } from '../../geometry/axes';
import type { JointPart, JointProtocol, Uncertain } from '../protocol/joint';
import { poseArray } from '../protocol/pose_array';
import type { Handlers } from './serve';

const UNKNOWN: readonly number[] = Array<number>(6).fill(NaN);

/** The joint between two components, open in this worker. */
export function joint(ready: Promise<unknown>): Handlers<JointProtocol> {
  let open: KneeJoint | null = null;
  return {
    openJoint: async ({ femur, tibia, side }) => {
      await ready;
      open?.free();
      open = null;
      open = new KneeJoint(...partOf(femur), ...partOf(tibia), side === 'left');
      return { columns: open.columns, hasPlate: open.hasPlate };
    },
    joint: async (frames) => {
      if (!open) throw new Error('No joint is open');
      const numbers = frames.flatMap(({ femur, tibia }) => [...uncertain(femur), ...uncertain(tibia)]);
      return open.numbers(Float64Array.from(numbers)) as Float64Array<ArrayBuffer>;
    },
  };
}

function partOf({ mesh, axes }: JointPart): [Float32Array, Uint32Array, Float64Array] {
  return [mesh?.vertices ?? new Float32Array(), mesh?.triangles ?? new Uint32Array(), numbersOf(axes)];
}

function uncertain({ pose, deviations }: Uncertain): readonly number[] {
  return [...poseArray(pose), ...(deviations ? poseArray(deviations) : UNKNOWN)];
}
