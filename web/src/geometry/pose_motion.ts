import type { Locks, PoseNumbers } from './pose_numbers';

/**
 * Motions of a pose as a hand makes them. Camera frame: x right, y up, looking along -z; millimetres and degrees;
 * `R = Rz(zRot) * Rx(xRot) * Ry(yRot)`, as everywhere in the project. Turns leave the middle of the model where it is:
 * the origin of a CAD file may lie far from the part. What is locked keeps its number, whatever that does to the rest.
 */
export type Vector = readonly [number, number, number];
export type Matrix = readonly [Vector, Vector, Vector];

export interface Pinhole {
  readonly fx: number;
  readonly fy: number;
  readonly cx: number;
  readonly cy: number;
}

const radians = (degrees: number): number => (degrees * Math.PI) / 180;

export function rotationOf({ zRot, xRot, yRot }: PoseNumbers): Matrix {
  const [sz, cz] = [Math.sin(radians(zRot)), Math.cos(radians(zRot))];
  const [sx, cx] = [Math.sin(radians(xRot)), Math.cos(radians(xRot))];
  const [sy, cy] = [Math.sin(radians(yRot)), Math.cos(radians(yRot))];
  return [
    [cz * cy - sz * sx * sy, -sz * cx, cz * sy + sz * sx * cy],
    [sz * cy + cz * sx * sy, cz * cx, sz * sy - cz * sx * cy],
    [-cx * sy, sx, cx * cy],
  ];
}

export function applied(matrix: Matrix, [x, y, z]: Vector): Vector {
  const row = ([a, b, c]: Vector) => a * x + b * y + c * z;
  return [row(matrix[0]), row(matrix[1]), row(matrix[2])];
}

/** A point of the model in camera coordinates. */
export function inCamera(pose: PoseNumbers, point: Vector): Vector {
  const [x, y, z] = applied(rotationOf(pose), point);
  return [x + pose.x, y + pose.y, z + pose.z];
}

/** Column and row of a point in camera coordinates; null behind the focus. */
export function projected({ fx, fy, cx, cy }: Pinhole, [x, y, z]: Vector): { column: number; row: number } | null {
  return z < 0 ? { column: cx + (fx * x) / -z, row: cy - (fy * y) / -z } : null;
}

/** One number more or less. A rotation turns about the middle of the model, so that it stays on view. */
export function nudged(pose: PoseNumbers, field: keyof PoseNumbers, by: number, middle: Vector, locks: Locks): PoseNumbers {
  const changed = { ...pose, [field]: pose[field] + by };
  return kept(pose, isTurn(field) ? aboutMiddle(pose, tidy(changed), middle) : changed, locks);
}

/** In the image plane, mm. */
export function shifted(pose: PoseNumbers, right: number, up: number, locks: Locks): PoseNumbers {
  return kept(pose, { ...pose, x: pose.x + right, y: pose.y + up }, locks);
}

/** The middle of the model comes nearer or goes farther along its ray, so that it stays where it is in the picture. */
export function movedInDepth(pose: PoseNumbers, by: number, middle: Vector, locks: Locks): PoseNumbers {
  if (locks.z) return pose;
  const [x, y, z] = inCamera(pose, middle);
  const fraction = Math.min(by, -z - NEAREST) / z;
  return kept(pose, { ...pose, x: pose.x + x * fraction, y: pose.y + y * fraction, z: pose.z + z * fraction }, locks);
}

/** The model does not come nearer to the focus than this, mm. */
const NEAREST = 10;

/**
 * Turns by a small rotation vector in camera axes, degrees. Where rotations are locked, the others come as near to it as
 * they can.
 */
export function rotated(pose: PoseNumbers, by: Vector, middle: Vector, locks: Locks): PoseNumbers {
  const fields = (['zRot', 'xRot', 'yRot'] as const).filter((field) => !locks[field]);
  const axes = axesOf(pose);
  const steps = leastSquares(fields.map((field) => axes[field]), by);
  const changed = { ...pose };
  fields.forEach((field, index) => (changed[field] += steps[index] ?? 0));
  return kept(pose, aboutMiddle(pose, tidy(changed), middle), locks);
}

/** The axes about which the three angles turn, in the camera. */
function axesOf({ zRot, xRot }: PoseNumbers): Record<'zRot' | 'xRot' | 'yRot', Vector> {
  const [sz, cz] = [Math.sin(radians(zRot)), Math.cos(radians(zRot))];
  const [sx, cx] = [Math.sin(radians(xRot)), Math.cos(radians(xRot))];
  return { zRot: [0, 0, 1], xRot: [cz, sz, 0], yRot: [-sz * cx, cz * cx, sx] };
}

/** Factors that bring the sum of the vectors nearest to `wanted`; a grain of damping holds where they are parallel. */
function leastSquares(vectors: readonly Vector[], wanted: Vector): number[] {
  const rows = vectors.map((vector, index) => {
    const products = vectors.map((other, at) => dot(vector, other) + (at === index ? DAMPING : 0));
    return [...products, dot(vector, wanted)];
  });
  return eliminated(rows);
}

const DAMPING = 1e-4;

/** Gauss and Jordan on a positive definite system with its right side as the last column. */
function eliminated(rows: number[][]): number[] {
  rows.forEach((pivotRow, at) => {
    const pivot = pivotRow[at] ?? 1;
    for (const row of rows) {
      if (row === pivotRow) continue;
      const factor = (row[at] ?? 0) / pivot;
      pivotRow.forEach((value, column) => (row[column] = (row[column] ?? 0) - factor * value));
    }
  });
  return rows.map((row, at) => (row.at(-1) ?? 0) / (row[at] ?? 1));
}

function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** The pose with the new angles whose middle lies where that of `before` did. */
function aboutMiddle(before: PoseNumbers, after: PoseNumbers, middle: Vector): PoseNumbers {
  const old = inCamera(before, middle);
  const [x, y, z] = applied(rotationOf(after), middle);
  return { ...after, x: old[0] - x, y: old[1] - y, z: old[2] - z };
}

function kept(before: PoseNumbers, after: PoseNumbers, locks: Locks): PoseNumbers {
  const result = { ...after };
  for (const field of Object.keys(locks) as (keyof PoseNumbers)[]) if (locks[field]) result[field] = before[field];
  return result;
}

export function isTurn(field: keyof PoseNumbers): boolean {
  return field === 'zRot' || field === 'xRot' || field === 'yRot';
}

/** z and y go round, x stops upright: beyond that the same rotation has other numbers. */
function tidy(pose: PoseNumbers): PoseNumbers {
  const xRot = Math.min(90, Math.max(-90, pose.xRot));
  return { ...pose, zRot: wrapped(pose.zRot), xRot, yRot: wrapped(pose.yRot) };
}

/** The same angle from -180 to 180. */
export function wrapped(degrees: number): number {
  const round = degrees - 360 * Math.round(degrees / 360);
  return round === -180 ? 180 : round;
}

/** The angle of the rotation that leads from one pose to another, degrees. */
export function turnBetween(a: PoseNumbers, b: PoseNumbers): number {
  const [p, q] = [rotationOf(a), rotationOf(b)];
  const squares = p.flatMap((row, r) => row.map((value, c) => (value - (q[r]?.[c] ?? 0)) ** 2)).reduce((sum, square) => sum + square, 0);
  // |P - Q| = 2 sqrt(2) sin(angle / 2) keeps the digits that the arc cosine of the trace loses.
  return (2 * Math.asin(Math.min(1, Math.sqrt(squares / 8))) * 180) / Math.PI;
}
