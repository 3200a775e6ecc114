import { checkComponent, checkHints, checkImage, checkOptions, checkOutline, checkPose, checkSquare, isBytes } from './asked.js';
import { decodeModel } from './decode.js';
import { filmNumbers } from './film.js';
import { withImage } from './frame_image.js';
import { buildLibrary } from './library.js';
import init, { calibrationText, cameraDoubts, HiddenPixels, Matcher, Surroundings, Traced, type Match } from './pkg/core/fluoropose_wasm.js';
import { read } from './read.js';
import type { Beside, Candidate, FoundPose, Grey, Hints, ImplantOptions, Mesh, Point, Pose, Shaped, Size, Verdict } from './types.js';

export { estimateFilm, type FilmSource } from './film.js';
export type { Beside, Candidate, Film, FilmConstants, FoundPose, Grey, Hints, ImplantOptions, Mesh, Point, Pose, Shaped, Size, StatedFilm, Verdict, Views } from './types.js';

let ready: Promise<unknown> | undefined;

/**
 * Opens an implant for frames of one camera. Rendering its library takes some seconds; `Implant.library` spares the
 * next time that. Rejects with a sentence about whatever is wrong with model, calibration or library.
 */
export async function openImplant(options: ImplantOptions): Promise<Implant> {
  checkOptions(options);
  const address = new URL('./pkg/core/fluoropose_wasm_bg.wasm', import.meta.url);
  await (ready ??= init({ module_or_path: read(address) }));
  const { model, frame, signal } = options;
  const calibration = calibrationText(options.calibration);
  signal?.throwIfAborted();
  const { mesh, notes } = isBytes(model) ? await decodeModel(new Uint8Array(model)) : { mesh: model, notes: [] };
  const library = options.library ? asBytes(options.library) : await buildLibrary(mesh, { ...options, calibration });
  return new Implant(mesh, library, calibration, frame, notes);
}

/** One component with its library. Its memory is WebAssembly's: call `close` when it is no longer wanted. */
export class Implant {
  /** The library's bytes, to be kept for the next time. */
  readonly library: Uint8Array;
  /**
   * What a person should know of model and calibration, a sentence each: holes, a size that is no knee component's in millimetres, a
   * camera of unusual numbers. Empty where nothing is unusual; poses are found all the same.
   */
  readonly remarks: readonly string[];
  readonly #opened: Matcher;
  readonly #calibration: string;
  readonly #frame: Size;
  #closed = false;

  /** Use `openImplant`. */
  constructor(mesh: Mesh, library: Uint8Array, calibration: string, frame: Size, notes: readonly string[] = []) {
    const camera = cameraDoubts(calibration, frame.width, frame.height);
    this.library = library;
    this.#opened = opened(library, mesh);
    const model = [...notes, ...this.#opened.remarks];
    this.remarks = [...model.map((remark) => `model: ${remark}`), ...camera.map((doubt) => `camera: ${doubt}`)];
    this.#calibration = calibration;
    this.#frame = frame;
  }

  /**
   * The pose that brings the model's outline onto a traced one, refined: some tenths of a second. With `hints.image` it is then brought
   * onto the edges of the frame itself, where `hints.film` puts them. Throws a sentence about an outline from which no pose
   * can be found, and where the outline does not fit this model from any side.
   */
  pose(outline: readonly Point[], hints: Hints = {}): FoundPose {
    checkOutline(outline);
    checkHints(hints, this.#frame, 'pose');
    const around = surroundings(hints, this);
    try {
      const { image, film, bright } = hints;
      return this.#look(outline, hints, (traced) =>
        image
          ? withImage(image, this.#frame, (frame) => this.#matcher.refineImage(traced, frame, filmNumbers(film, this), bright, around))
          : this.#matcher.refineOutline(traced, around),
      );
    } finally {
      around.free();
    }
  }

  /** The library's pose, unrefined: some milliseconds, for an outline that is still moving. */
  preview(outline: readonly Point[], hints: Hints = {}): FoundPose {
    checkOutline(outline);
    checkHints(hints, this.#frame, 'preview');
    return this.#look(outline, hints, (traced) => this.#matcher.matchOutline(traced));
  }

  /** Profiles of a frame, in squares with sides of so many pixels, across the model's outline at a pose: what `estimateFilm` reads. */
  profiles(image: Grey, pose: Pose, squarePx = 1): Float32Array {
    checkPose(pose, 'profiles: pose');
    checkSquare(squarePx);
    checkImage(image, this.#frame, 'profiles');
    const { width, height } = this.#frame;
    const hidden = new HiddenPixels(this.#calibration, width, height);
    try {
      return withImage(image, this.#frame, (frame) => this.#matcher.filmProfiles(frame, hidden, numbers(pose), squarePx));
    } finally {
      hidden.free();
    }
  }

  /**
   * The directions anterior, superior and to the patient's right in the model's file, nine numbers, as its shape tells them. Throws where it
   * does not.
   */
  axes(component: 'femur' | 'tibia'): Float64Array {
    checkComponent(component);
    const axes = this.#matcher.axes(component === 'femur')!;
    const { told, directions } = axes;
    axes.free();
    if (told === 'nothing') throw new Error(`The shape of the ${component} does not tell its axes: leave it out, or give its pose alone where both files have the field's axes`);
    return directions;
  }

  /** Lets go of WebAssembly's memory; `library` stays. To close it twice does nothing more. */
  close(): void {
    if (!this.#closed) this.#opened.free();
    this.#closed = true;
  }

  get #matcher(): Matcher {
    if (this.#closed) throw new Error('This implant was closed and finds no poses any more: open it again, openImplant with its library is quick');
    return this.#opened;
  }

  #look(outline: readonly Point[], { unknownSides = [], laidBy = 'hand' }: Hints, find: (traced: Traced) => Match): FoundPose {
    const { width, height } = this.#frame;
    const sides = Uint32Array.from(unknownSides);
    const traced = new Traced(Float64Array.from(outline.flat()), sides, this.#calibration, width, height);
    try {
      traced.laidBy(laidBy);
      return copied(find(traced));
    } finally {
      traced.free();
    }
  }
}

/** A library with its model. What is refused is let go of at once: whoever tries several libraries would fill the memory. */
function opened(library: Uint8Array, { vertices, triangles }: Mesh): Matcher {
  const matcher = new Matcher(library);
  try {
    matcher.takeModel(vertices, triangles);
    return matcher;
  } catch (error) {
    matcher.free();
    throw error;
  }
}

/** The same object where it is one: an implant's library is what was given. */
function asBytes(library: Uint8Array | ArrayBuffer): Uint8Array {
  return library instanceof Uint8Array ? library : new Uint8Array(library);
}

function surroundings({ femur, tibia, neighbours = [] }: Hints, own: Shaped): Surroundings {
  const around = new Surroundings();
  try {
    const other = femur ?? tibia;
    if (other && 'implant' in other) around.setAxes(own.axes(femur ? 'tibia' : 'femur'));
    if (femur) around.setFemur(...lying(femur, 'femur'));
    if (tibia) around.setTibia(...lying(tibia, 'tibia'));
    for (const pose of neighbours) around.addNeighbour(numbers(pose));
    return around;
  } catch (error) {
    around.free();
    throw error;
  }
}

/** A pose, and the axes of its implant where that is there. */
function lying(beside: Beside | Pose, component: 'femur' | 'tibia'): readonly [Float64Array, Float64Array?] {
  return 'implant' in beside ? [numbers(beside.pose), beside.implant.axes(component)] : [numbers(beside)];
}

/** Copies what was found out of WebAssembly's memory and frees it there. */
function copied(match: Match): FoundPose {
  try {
    const { decided, partial, reason = null } = match;
    const verdict = verdictOf(match);
    const candidates = Array.from({ length: match.count }, (_, index) => candidate(match, index));
    const [best] = candidates;
    if (!best) throw new Error('No view of the library explains this outline');
    return { pose: best.pose, candidates, decided, reason, verdict, partial };
  } finally {
    match.free();
  }
}

/** Throws where nothing fits. */
function verdictOf({ verdict: word, because = '' }: Match): Verdict | null {
  if (word === 'none') throw new Error(`${because.charAt(0).toUpperCase()}${because.slice(1)}`);
  return word === 'good' || word === 'doubtful' ? { word, because } : null;
}

function candidate(match: Match, index: number): Candidate {
  // Its first six numbers; the rest is their covariance.
  const deviations = match.uncertainty(index);
  return {
    pose: pose(match.pose(index) ?? []),
    deviations: deviations ? pose(deviations) : null,
    residual: match.residual(index) ?? null,
    unmatched: match.unmatched(index) ?? null,
    atBorder: match.atBorder(index) ?? false,
  };
}

function numbers({ x, y, z, zRot, xRot, yRot }: Pose): Float64Array {
  return Float64Array.of(x, y, z, zRot, xRot, yRot);
}

function pose(values: ArrayLike<number>): Pose {
  const [x = 0, y = 0, z = 0, zRot = 0, xRot = 0, yRot = 0] = Array.from(values);
  return { x, y, z, zRot, xRot, yRot };
}
