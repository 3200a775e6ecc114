import type { Hints, ImplantOptions, Point } from './types.js';

/** What a caller gives, looked at before anything is done with it: a sentence that says what was wrong and what to give. */

const OPTIONS = ['model', 'calibration', 'frame', 'library', 'views', 'onProgress', 'signal'] as const satisfies readonly (keyof ImplantOptions)[];
const VIEWS = ['nominal', 'x', 'y', 'distance'] as const;
const HINTS = ['unknownSides', 'laidBy', 'femur', 'tibia', 'neighbours', 'image', 'bright', 'film'] as const satisfies readonly (keyof Hints)[];
const POSE = ['x', 'y', 'z', 'zRot', 'xRot', 'yRot'] as const;

export function checkOptions(options: unknown): void {
  const given = known(options, OPTIONS, 'openImplant');
  const { model, calibration, frame, views } = given;
  if (!model || typeof model !== 'object') throw new Error('openImplant: model should be the bytes of an STL, OBJ or PLY file (Uint8Array or ArrayBuffer), or { vertices, triangles }');
  if (typeof calibration !== 'string') throw new Error('openImplant: calibration should be the text of a JT_INTCALIB or MayaCam 2.0 file');
  if (!isObject(frame) || !isSize(frame['width']) || !isSize(frame['height'])) throw new Error('openImplant: frame should be { width, height }, the size of the frames in whole pixels');
  if (views !== undefined) known(views, VIEWS, 'openImplant, views');
}

export function checkOutline(outline: unknown): asserts outline is readonly Point[] {
  const isPoint = (point: unknown) => Array.isArray(point) && point.length === 2 && point.every((value) => typeof value === 'number');
  if (Array.isArray(outline) && outline.every(isPoint)) return;
  throw new Error('The outline should be an array of points [column, row], two numbers each, in pixels of the frame; whole numbers are corners of pixels');
}

export function checkHints(hints: unknown, from: string): void {
  const given = known(hints, HINTS, from);
  const { femur, tibia, neighbours = [] } = given;
  for (const [name, pose] of Object.entries({ femur, tibia })) if (pose !== undefined) checkPose(pose, `${from}: ${name}`);
  if (!Array.isArray(neighbours)) throw new Error(`${from}: neighbours should be an array of poses`);
  for (const pose of neighbours) checkPose(pose, `${from}: neighbours`);
}

export function checkPose(pose: unknown, from: string): void {
  if (isObject(pose) && POSE.every((name) => typeof pose[name] === 'number')) return;
  throw new Error(`${from} should be a pose { x, y, z, zRot, xRot, yRot } in mm and degrees`);
}

/** The same object, when it has no property but these. */
function known(given: unknown, names: readonly string[], from: string): Readonly<Record<string, unknown>> {
  if (!isObject(given)) throw new Error(`${from} takes an object with ${names.join(', ')}`);
  const other = Object.keys(given).find((name) => !names.includes(name));
  if (other !== undefined) throw new Error(`${from} has no option ${other}; it has ${names.join(', ')}`);
  return given;
}

function isObject(given: unknown): given is Readonly<Record<string, unknown>> {
  return typeof given === 'object' && given !== null;
}

function isSize(value: unknown): boolean {
  return Number.isInteger(value) && (value as number) > 0;
}
