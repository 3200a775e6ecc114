import { applied, type Matrix, type Vector } from './pose_motion';
import type { PoseNumbers } from './pose_numbers';

/** Which way a component lies in the coordinates of its file. */

/** Anterior, superior and to the patient's right: unit vectors in the file's coordinates, a right-handed frame. */
export type Directions = readonly [anterior: Vector, superior: Vector, right: Vector];

/** One of the file's axes, or its opposite. */
/** Directions with their signs, and whether front and back are told apart. */
export interface SignedDirections {
  readonly directions: Directions;
  readonly front: boolean;
}

export const AXIS_WORDS = ['x', '-x', 'y', '-y', 'z', '-z'] as const;
export type AxisWord = (typeof AXIS_WORDS)[number];

export function directionOf(word: AxisWord): Vector {
  const value = word.startsWith('-') ? -1 : 1;
  const name = word.at(-1);
  return [name === 'x' ? value : 0, name === 'y' ? value : 0, name === 'z' ? value : 0];
}

/** Null for a direction that is none of the file's axes. */
export function wordOf(direction: Vector): AxisWord | null {
  return AXIS_WORDS.find((word) => dot(directionOf(word), direction) > 1 - 1e-9) ?? null;
}

/** Two directions tell the third; null where they are not at right angles. */
export function directionsOf(anterior: AxisWord, superior: AxisWord): Directions | null {
  const [a, s] = [directionOf(anterior), directionOf(superior)];
  return dot(a, s) === 0 ? [a, s, cross(a, s)] : null;
}

/** Sine of a degree: what a person measures is at right angles to within that, as the core has it. */
const SQUARE = 0.017452;

/** Words as a study file has them, read as the core does: the file's anterior, superior and right. Null where they are no right-handed frame. */
export function directionsFromWords(text: string): Directions | null {
  const words = text.match(/\([^)]*\)|[^\s(]+/g)?.map(directionFromWord) ?? [];
  const [anterior, superior, right] = words;
  if (words.length !== 3 || !anterior || !superior || !right || dot(cross(anterior, superior), right) < 0.5) return null;
  const isSkew = [dot(anterior, superior), dot(superior, right), dot(right, anterior)].some((cosine) => Math.abs(cosine) > SQUARE);
  const across = unit(cross(anterior, superior));
  return isSkew || !across ? null : [cross(superior, across), superior, across];
}

/** A letter with its sign, or a direction of any length in brackets. */
function directionFromWord(word: string): Vector | null {
  const known = AXIS_WORDS.find((axis) => axis === word.replace(/^\+/, ''));
  if (known) return directionOf(known);
  const numbers = /^\((.*)\)$/.exec(word)?.[1]?.split(',').map((number) => (number.trim() === '' ? NaN : Number(number))) ?? [];
  const [x, y, z] = numbers;
  return numbers.length === 3 ? unit([x!, y!, z!]) : null;
}

/** Null where it has no direction. */
function unit([x, y, z]: Vector): Vector | null {
  const length = Math.hypot(x, y, z);
  return length > 0 && Number.isFinite(length) ? [x / length, y / length, z / length] : null;
}

/** The reverse; null where one of them is none of the file's axes. */
export function wordsOf(directions: Directions): readonly [AxisWord, AxisWord, AxisWord] | null {
  const [anterior, superior, right] = directions.map(wordOf);
  return anterior && superior && right ? [anterior, superior, right] : null;
}

/** Front and back change places, and with them right and left. */
export function facingTheOtherWay([anterior, superior, right]: Directions): Directions {
  return [opposite(anterior), superior, opposite(right)];
}

export function opposite([x, y, z]: Vector): Vector {
  // Not the zero that is written with a sign.
  return [0 - x, 0 - y, 0 - z];
}

/** Do both say the same of the tilt: the same lines are superior and mediolateral, in whichever direction? */
export function tiltAlike(a: Directions, b: Directions): boolean {
  return [1, 2].every((axis) => Math.abs(dot(a[axis]!, b[axis]!)) > 1 - 1e-9);
}

/** Unit vectors at right angles, right-handed. */
export function isFrame(directions: Directions): boolean {
  const [anterior, superior, right] = directions;
  const near = (value: number, wanted: number) => Math.abs(value - wanted) < 1e-6;
  const unit = directions.every((direction) => near(dot(direction, direction), 1));
  return unit && near(dot(anterior, superior), 0) && near(dot(cross(anterior, superior), right), 1);
}

/** As they cross into WASM. */
export function numbersOf(directions: Directions): Float64Array {
  return Float64Array.from(directions.flat());
}

export function directionsFrom(numbers: ArrayLike<number>): Directions {
  const at = (first: number): Vector => [numbers[first] ?? NaN, numbers[first + 1] ?? NaN, numbers[first + 2] ?? NaN];
  return [at(0), at(3), at(6)];
}

/**
 * A pose from which the camera sees a model from its right side: anterior to the right, superior up. `middle` of the model
 * lies on the optical axis.
 */
export function fromTheRight(directions: Directions, middle: Vector, away: number): PoseNumbers {
  const [x, y, z] = applied(directions, middle);
  return { x: -x, y: -y, z: -away - z, ...anglesOf(directions) };
}

/** Where one may look at a model from. */
export type ViewName = 'camera' | 'front' | 'side' | 'above';

/**
 * Where one looks from, and what is upwards there, in the camera's frame. With the axes of a model, seen at `rotation`, the
 * names are anatomical, and the side is the lateral one where it is known which that is; without, they are the camera's.
 */
export function viewpointOf(name: ViewName, rotation: Matrix, directions: Directions | null, side: 'left' | 'right' | 'unknown'): { from: Vector; up: Vector } {
  const [anterior, superior, right]: Directions = directions ? mapped(directions, (direction) => applied(rotation, direction)) : CAMERA;
  switch (name) {
    case 'camera':
      return { from: [0, 0, 1], up: [0, 1, 0] };
    case 'front':
      return { from: anterior, up: superior };
    case 'side':
      return { from: directions && side === 'left' ? opposite(right) : right, up: superior };
    case 'above':
      return { from: superior, up: anterior };
  }
}

/** The same words for the camera: from above, what is farther away is up. */
const CAMERA: Directions = [[0, 0, -1], [0, 1, 0], [1, 0, 0]];

function mapped([a, b, c]: Directions, map: (direction: Vector) => Vector): Directions {
  return [map(a), map(b), map(c)];
}

/** The angles of `R = Rz Rx Ry`. */
function anglesOf([a, b, c]: Matrix): Pick<PoseNumbers, 'zRot' | 'xRot' | 'yRot'> {
  const degrees = (radians: number) => (radians * 180) / Math.PI;
  const xRot = degrees(Math.asin(Math.min(1, Math.max(-1, c[1]))));
  // Upright, z and y turn about one axis: all of it is z's.
  if (Math.abs(c[1]) > 1 - 1e-9) return { zRot: degrees(Math.atan2(b[0], a[0])), xRot, yRot: 0 };
  return { zRot: degrees(Math.atan2(-a[1], b[1])), xRot, yRot: degrees(Math.atan2(-c[0], c[2])) };
}

function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a: Vector, b: Vector): Vector {
  const minor = (i: 0 | 1 | 2, j: 0 | 1 | 2) => a[i] * b[j] - a[j] * b[i] + 0;
  return [minor(1, 2), minor(2, 0), minor(0, 1)];
}
