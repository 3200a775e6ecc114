import type { Grey, Hints, ImplantOptions, Point, Size } from './types.js';

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

export function checkHints(hints: unknown, frame: Size, from: string): void {
  const given = known(hints, HINTS, from);
  const { unknownSides = [], femur, tibia, neighbours = [], image, film } = given;
  const isSide = (side: unknown) => Number.isInteger(side) && (side as number) >= 0;
  if (!Array.isArray(unknownSides) || !unknownSides.every(isSide)) {
    throw new Error(`${from}: unknownSides should be an array of whole numbers from 0, side i from point i of the outline to the next`);
  }
  if (film && !image) throw new Error(`${from}: film says how an image is to be read; give the image too, or leave film out`);
  if (image !== undefined && image !== null) checkImage(image, frame, from);
  for (const [name, beside] of Object.entries({ femur, tibia })) if (beside !== undefined) checkBeside(beside, `${from}: ${name}`);
  if (!Array.isArray(neighbours)) throw new Error(`${from}: neighbours should be an array of poses`);
  for (const pose of neighbours) checkPose(pose, `${from}: neighbours`);
}

/** Every number of other types would be taken for a grey value, cut to 16 bits. */
export function checkImage(image: unknown, { width, height }: Size, from: string): asserts image is Grey {
  if (!isGrey(image)) {
    throw new Error(`${from}: image is of type ${typeName(image)}; it should be the grey values of the frame, row by row, in a Uint8Array (8 bits) or a Uint16Array (up to 16 bits)`);
  }
  if (image.length !== width * height) {
    throw new Error(`${from}: image has ${image.length} values, and a frame of ${width} x ${height} pixels has ${width * height}: one grey value a pixel, no colours`);
  }
  const [first] = image;
  if (image.every((value) => value === first)) {
    throw new Error(`${from}: image has the grey value ${first} everywhere: nothing is to be seen in it; give the frame that was traced, or leave image out`);
  }
}

/** A pose, or an implant with its pose. */
function checkBeside(beside: unknown, from: string): void {
  if (!isObject(beside) || !('implant' in beside)) return checkPose(beside, from);
  const { implant, pose } = known(beside, ['implant', 'pose'], from);
  if (!isObject(implant) || typeof implant['axes'] !== 'function') throw new Error(`${from}: implant should be what openImplant gave`);
  checkPose(pose, `${from}: pose`);
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

/** By its name, so that an array of another window or context is one too. */
function isGrey(image: unknown): image is Grey {
  return ['Uint8Array', 'Uint16Array'].includes(typeName(image));
}

export function isEightBit(image: Grey): image is Uint8Array {
  return typeName(image) === 'Uint8Array';
}

function typeName(value: unknown): string {
  return Object.prototype.toString.call(value).slice('[object '.length, -1);
}

function isObject(given: unknown): given is Readonly<Record<string, unknown>> {
  return typeof given === 'object' && given !== null;
}

function isSize(value: unknown): boolean {
  return Number.isInteger(value) && (value as number) > 0;
}
