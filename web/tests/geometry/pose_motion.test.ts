import { describe, expect, it } from 'vitest';
import { NO_LOCKS, type PoseNumbers } from '../../src/geometry/pose_numbers';
import { applied, inCamera, movedInDepth, nudged, projected, rotationOf, shifted, turnBetween, rotated, type Vector } from '../../src/geometry/pose_motion';

const POSE: PoseNumbers = { x: 5, y: -12, z: -1000, zRot: 35, xRot: 8, yRot: -14 };
/** A CAD origin that lies beside the part. */
const MIDDLE: Vector = [30, -20, 55];
const CAMERA = { fx: 3200, fy: 3200, cx: 512, cy: 500 };

const imageOf = (pose: PoseNumbers) => projected(CAMERA, inCamera(pose, MIDDLE));
const near = (a: readonly number[], b: readonly number[], within: number) =>
  a.forEach((value, index) => expect(Math.abs(value - (b[index] ?? NaN)), `${a} and ${b}`).toBeLessThan(within));

describe('rotations', () => {
  it('are Rz Rx Ry: a hand-made product', () => {
    const axis = (field: 'zRot' | 'xRot' | 'yRot') => rotationOf({ x: 0, y: 0, z: 0, zRot: 0, xRot: 0, yRot: 0, [field]: POSE[field] });
    for (const point of [[1, 0, 0], [0, 1, 0], [0, 0, 1]] as const) {
      const product = applied(axis('zRot'), applied(axis('xRot'), applied(axis('yRot'), point)));
      near(applied(rotationOf(POSE), point), product, 1e-12);
    }
    // The core's signs: 90 degrees about z takes x to y, about x takes y to z, about y takes z to x.
    const quarter = { x: 0, y: 0, z: 0, zRot: 0, xRot: 0, yRot: 0 };
    near(applied(rotationOf({ ...quarter, zRot: 90 }), [1, 0, 0]), [0, 1, 0], 1e-12);
    near(applied(rotationOf({ ...quarter, xRot: 90 }), [0, 1, 0]), [0, 0, 1], 1e-12);
    near(applied(rotationOf({ ...quarter, yRot: 90 }), [0, 0, 1]), [1, 0, 0], 1e-12);
  });

  it('differ by the angle between them', () => {
    expect(turnBetween(POSE, POSE)).toBe(0);
    expect(turnBetween(POSE, { ...POSE, zRot: POSE.zRot + 3 })).toBeCloseTo(3, 9);
    expect(turnBetween(POSE, { ...POSE, yRot: POSE.yRot - 0.001 })).toBeCloseTo(0.001, 9);
  });
});

describe('nudges', () => {
  it('change one translation and nothing else', () => {
    expect(nudged(POSE, 'z', 10, MIDDLE, NO_LOCKS)).toEqual({ ...POSE, z: -990 });
  });

  it.each(['zRot', 'xRot', 'yRot'] as const)('of %s turn about the middle of the model', (field) => {
    const pose = nudged(POSE, field, 2.5, MIDDLE, NO_LOCKS);
    expect(pose[field]).toBeCloseTo(POSE[field] + 2.5, 12);
    near(inCamera(pose, MIDDLE), inCamera(POSE, MIDDLE), 1e-9);
    expect(pose.x).not.toBe(POSE.x);
  });

  it('leave what is locked, the translations of a turn too', () => {
    const locks = { ...NO_LOCKS, x: true, zRot: true };
    const pose = nudged(POSE, 'yRot', 5, MIDDLE, locks);
    expect([pose.x, pose.zRot]).toEqual([POSE.x, POSE.zRot]);
    expect(nudged(POSE, 'x', 5, MIDDLE, locks)).toEqual(POSE);
  });

  it('go round at 180 degrees and stop at 90 about x', () => {
    expect(nudged({ ...POSE, zRot: 179.5 }, 'zRot', 1, MIDDLE, NO_LOCKS).zRot).toBeCloseTo(-179.5, 9);
    expect(nudged({ ...POSE, xRot: 89.5 }, 'xRot', 1, MIDDLE, NO_LOCKS).xRot).toBe(90);
  });
});

describe('the mouse', () => {
  it('moves in the plane', () => {
    expect(shifted(POSE, 3, -2, { ...NO_LOCKS, y: true })).toEqual({ ...POSE, x: 8 });
  });

  it('moves along the ray: what is seen stays in its place', () => {
    const pose = movedInDepth(POSE, 40, MIDDLE, NO_LOCKS);
    expect(inCamera(pose, MIDDLE)[2]).toBeCloseTo(inCamera(POSE, MIDDLE)[2] + 40, 9);
    const [before, after] = [imageOf(POSE), imageOf(pose)];
    near([after?.column ?? NaN, after?.row ?? NaN], [before?.column ?? NaN, before?.row ?? NaN], 1e-9);
    expect(movedInDepth(POSE, 40, MIDDLE, { ...NO_LOCKS, z: true })).toEqual(POSE);
  });

  it('never brings the model behind the focus', () => {
    const pose = movedInDepth(POSE, 5000, MIDDLE, NO_LOCKS);
    expect(inCamera(pose, MIDDLE)[2]).toBeLessThan(0);
  });

  it('tilts about lines across the view whatever the turn in the plane', () => {
    for (const zRot of [0, 35, 90, -160]) {
      const before = { ...POSE, zRot };
      const after = rotated(before, [0.5, 0, 0], MIDDLE, NO_LOCKS);
      expect(turnBetween(before, after)).toBeCloseTo(0.5, 2);
      // A point of the camera's x axis through the middle stays.
      const [r, s] = [rotationOf(before), rotationOf(after)];
      const back = (m: typeof r, v: Vector) => applied([[m[0][0], m[1][0], m[2][0]], [m[0][1], m[1][1], m[2][1]], [m[0][2], m[1][2], m[2][2]]], v);
      near(applied(s, back(r, [1, 0, 0])), [1, 0, 0], 1e-3);
      near(inCamera(after, MIDDLE), inCamera(before, MIDDLE), 1e-9);
    }
  });

  it('comes as near as it can where a rotation is locked', () => {
    const after = rotated(POSE, [1, 1, 0], MIDDLE, { ...NO_LOCKS, yRot: true });
    expect(after.yRot).toBe(POSE.yRot);
    expect(turnBetween(POSE, after)).toBeGreaterThan(0.3);
    expect(rotated(POSE, [1, 1, 1], MIDDLE, { ...NO_LOCKS, zRot: true, xRot: true, yRot: true })).toEqual(POSE);
  });
});
