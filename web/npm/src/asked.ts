import type { Grey, Hints, ImplantOptions, Point, Size } from './types.js';

/** What a caller gives, looked at before anything is done with it: a sentence that says what was wrong and what to give. */

const OPTIONS = ['model', 'calibration', 'frame', 'library', 'views', 'onProgress', 'signal'] as const satisfies readonly (keyof ImplantOptions)[];
const VIEWS = ['nominal', 'x', 'y', 'distance'] as const;
const HINTS = ['unknownSides', 'laidBy', 'femur', 'tibia', 'neighbours', 'image', 'bright', 'film'] as const satisfies readonly (keyof Hints)[];
const LAID_BY: readonly unknown[] = ['hand', 'drawn', 'tool', 'mixed'] as const satisfies readonly Hints['laidBy'][];
const POSE = ['x', 'y', 'z', 'zRot', 'xRot', 'yRot'] as const;

/** WebAssembly takes whole numbers of 32 bits, and what is left over of larger ones. */
const BEYOND = 2 ** 32;

export function checkOptions(options: unknown): void {
  const given = known(options, OPTIONS, 'openImplant');
  const { model, calibration, frame, library, views, onProgress, signal } = given;
  checkModel(model);
  if (typeof calibration !== 'string') throw new Error('openImplant: calibration should be the text of a JT_INTCALIB or MayaCam 2.0 file');
  const { width, height } = isObject(frame) ? frame : {};
  if (!isSize(width) || !isSize(height)) throw new Error(`openImplant: frame should be { width, height }, the size of the frames in whole pixels, not ${width} x ${height}`);
  if (!isNothing(library) && !isBytes(library)) throw new Error('openImplant: library should be the bytes of Implant.library (Uint8Array or ArrayBuffer)');
  if (views !== undefined) checkViews(views);
  if (views !== undefined && !isNothing(library)) throw new Error('openImplant: views says what to render, and a library is rendered: give one of them');
  if (!isNothing(onProgress) && typeof onProgress !== 'function') throw new Error('openImplant: onProgress should be a function');
  if (!isNothing(signal) && !(isObject(signal) && typeof signal['throwIfAborted'] === 'function')) throw new Error('openImplant: signal should be that of an AbortController');
}

function checkModel(model: unknown): void {
  if (isBytes(model)) return;
  if (!isObject(model) || !('vertices' in model)) throw new Error('openImplant: model should be the bytes of an STL, OBJ or PLY file (Uint8Array or ArrayBuffer), or { vertices, triangles }');
  const { vertices, triangles } = model;
  if (isNumbers(vertices) && isNumbers(triangles) && triangles.every(isIndex)) return;
  throw new Error('openImplant: model should have vertices, x, y, z of each in mm (Float32Array), and triangles, three vertex numbers of each from 0 (Uint32Array)');
}

function checkViews(views: unknown): void {
  const given = known(views, VIEWS, 'openImplant, views');
  for (const [name, length, words] of [['nominal', 2, '[x, y]'], ['x', 3, '[from, to, step]'], ['y', 3, '[from, to, step]']] as const) {
    const range = given[name];
    if (isNothing(range) || (Array.isArray(range) && range.length === length && range.every(Number.isFinite))) continue;
    throw new Error(`openImplant, views: ${name} should be ${words}, numbers in degrees`);
  }
  const { distance } = given;
  if (!isNothing(distance) && typeof distance !== 'number') throw new Error('openImplant, views: distance should be a number in mm');
}

export function checkOutline(outline: unknown): asserts outline is readonly Point[] {
  const isPoint = (point: unknown) => Array.isArray(point) && point.length === 2 && point.every((value) => typeof value === 'number');
  if (Array.isArray(outline) && outline.every(isPoint)) return;
  throw new Error('The outline should be an array of points [column, row], two numbers each, in pixels of the frame; whole numbers are corners of pixels');
}

export function checkHints(hints: unknown, frame: Size, from: string): void {
  const given = known(hints, HINTS, from);
  const { unknownSides = [], laidBy, femur, tibia, neighbours = [], image, bright, film } = given;
  if (!Array.isArray(unknownSides) || !unknownSides.every(isIndex)) {
    throw new Error(`${from}: unknownSides should be an array of whole numbers from 0, side i from point i of the outline to the next`);
  }
  if (laidBy !== undefined && !LAID_BY.includes(laidBy)) throw new Error(`${from}: laidBy should be one of ${LAID_BY.join(', ')}`);
  if (!isNothing(bright) && typeof bright !== 'boolean') throw new Error(`${from}: bright should be true or false, or be left out where the frame tells it`);
  if (film && !image) throw new Error(`${from}: film says how an image is to be read; give the image too, or leave film out`);
  if (!isNothing(film)) checkFilm(film, `${from}: film`);
  if (!isNothing(image)) checkImage(image, frame, from);
  for (const [name, beside] of Object.entries({ femur, tibia })) if (beside !== undefined) checkBeside(beside, `${from}: ${name}`);
  if (femur !== undefined && tibia !== undefined) throw new Error(`${from}: femur and tibia are each the other component; give the one that this implant is not`);
  if (!Array.isArray(neighbours)) throw new Error(`${from}: neighbours should be an array of poses`);
  for (const pose of neighbours) checkPose(pose, `${from}: neighbours`);
}

/** What is stated, or what `estimateFilm` gave. */
function checkFilm(film: unknown, from: string): void {
  if (isObject(film) && 'models' in film && typeName(film['models']) === 'Map') return;
  const { curvature, blur, attenuation } = isObject(film) ? known(film, ['curvature', 'blur', 'attenuation'], from) : {};
  if (![curvature, blur, attenuation].every(Number.isFinite) || (curvature as number) < 0 || (attenuation as number) <= 0) {
    throw new Error(`${from} should be what estimateFilm gave, or { curvature, blur, attenuation }: numbers, the first 0 or more, the others above 0`);
  }
  checkBlur(blur, from);
}

/** The core reads a film in squares of 4 pixels at most, and takes a blur of 3 of their sides where it is told of more. */
function checkBlur(blur: unknown, from: string): void {
  const most = 12;
  if (typeof blur === 'number' && blur > 0 && blur <= most) return;
  throw new Error(`${from}: blur should be a number of pixels above 0, and at most ${most}: of a film that is blurred more, frames in larger pixels tell as much`);
}

export function checkSources(sources: unknown): void {
  if (!Array.isArray(sources)) throw new Error('estimateFilm takes an array of { implant, image, pose }');
  for (const source of sources) {
    if (!isObject(source)) throw new Error('estimateFilm: each of its frames should be { implant, image, pose }');
    checkImplant(source['implant'], 'profiles', 'estimateFilm');
  }
}

export function checkStated(stated: unknown): void {
  const { display, blur } = known(stated, ['display', 'blur'], 'estimateFilm, what is stated,');
  if (display !== undefined && typeof display !== 'string') throw new Error('estimateFilm: display should be linear, between or logarithmic');
  if (blur !== undefined) checkBlur(blur, 'estimateFilm');
}

export function checkComponent(component: unknown): void {
  if (component !== 'femur' && component !== 'tibia') throw new Error('axes: component should be femur or tibia');
}

export function checkSquare(squarePx: unknown): void {
  if (!isSize(squarePx)) throw new Error('profiles: squarePx should be a whole number of pixels from 1');
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
  checkImplant(implant, 'axes', from);
  checkPose(pose, `${from}: pose`);
}

/** By the one thing that is asked of it. */
function checkImplant(implant: unknown, asked: 'axes' | 'profiles', from: string): void {
  if (!isObject(implant) || typeof implant[asked] !== 'function') throw new Error(`${from}: implant should be what openImplant gave`);
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

function isNothing(value: unknown): value is null | undefined {
  return value === undefined || value === null;
}

export function isBytes(value: unknown): value is Uint8Array | ArrayBuffer {
  return ['Uint8Array', 'Uint8ClampedArray', 'ArrayBuffer', 'SharedArrayBuffer'].includes(typeName(value));
}

function isNumbers(value: unknown): value is readonly unknown[] {
  return Array.isArray(value) || (ArrayBuffer.isView(value) && typeName(value) !== 'DataView');
}

function isIndex(value: unknown): boolean {
  return Number.isInteger(value) && (value as number) >= 0 && (value as number) < BEYOND;
}

function isSize(value: unknown): boolean {
  return isIndex(value) && value !== 0;
}
