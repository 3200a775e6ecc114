import { pictureOf } from '../document/same_frames';
import init, {
  CalibrationText,
  checkLibrary,
  FrameImage,
  jointMotion,
  jtIntcalibText,
  Model,
  paintUnmatched,
  plateCamera,
  readJts,
  rulerScale,
  unknownReach,
  writeJts,
} from '../pkg/page/fluoropose_page.js';
import wasmAddress from '../pkg/page/fluoropose_page_bg.wasm?url';
import type { GreyWindow } from '../document/types';
import { numbersOf } from '../geometry/axes';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { Distortion } from '../document/distortion';
import type { FramePoint } from '../geometry/points';
import type { Size } from '../geometry/viewport';
import type { Motion, PlacedInJoint } from '../results/motion';
import { poseArray, poseFrom } from '../workers/protocol/pose_array';
import { paintPreprocessed } from './preprocessing';
import type { Preprocessing } from '../terms/seeing';
import type { FramePixels } from '../workers/protocol/frame_pixels';
import type { Picture } from '../workers/protocol/match';
import type { DecodedFrame, ModelMesh, StatedGeometry } from '../workers/protocol/decode';
import type { DistortionInput, CalibrationFacts, CameraInput } from '../workers/protocol/camera';
import { OverlayDistorter, UndistortedFrames } from './undistorted';
import { numbersAt } from './wasm_view';

/** Grey values of a frame, and the window to begin with. */
export interface FrameFacts {
  readonly least: number;
  readonly greatest: number;
  readonly window: GreyWindow;
}

interface HeldFrame {
  /** As it was taken. */
  readonly image: FrameImage;
  readonly facts: FrameFacts;
  readonly size: Size;
  readonly stated: StatedGeometry;
}

interface HeldModel {
  readonly mesh: ModelMesh;
  readonly model: Model;
  /** Once somebody asked. */
  remarks?: readonly string[];
}

/** Part of a canvas, its pixels. */
export interface Box extends Size {
  readonly left: number;
  readonly top: number;
}

interface PaintedSilhouette {
  /** Columns and rows of its corners by turns, in WASM memory: to be read before the studio is asked for anything else. */
  readonly border: Float64Array;
  /** What was painted on a canvas of the frame's size; null where to fill the border is the same. */
  readonly box: Box | null;
}

/**
 * The core on the page's own thread: holds pixels and models in WASM memory and paints them. Matching is the pose
 * worker's work.
 */
export class Studio {
  readonly #memory: WebAssembly.Memory;
  readonly #frames = new Map<string, HeldFrame>();
  readonly #undistorted = new UndistortedFrames();
  #distorter: OverlayDistorter | null = null;
  /** By the file's SHA-256: undo may go back to an earlier one. */
  readonly #models = new Map<string, HeldModel>();

  private constructor(memory: WebAssembly.Memory) {
    this.#memory = memory;
  }

  static async open(): Promise<Studio> {
    const { memory } = await init({ module_or_path: wasmAddress });
    return new Studio(memory);
  }

  // --- Frames -------------------------------------------------------------------------------------------------

  addFrame(id: string, frame: DecodedFrame): void {
    if (this.#frames.has(pictureOf(id))) return;
    const { pixels, width, height } = frame;
    const image =
      pixels instanceof Uint8Array ? FrameImage.fromEightBit(pixels, width, height) : FrameImage.fromSixteenBit(pixels, width, height);
    const [least = 0, greatest = 255, centre = 128, windowWidth = 256] = image.greyRange();
    const window = frame.window ?? { centre, width: windowWidth };
    this.#frames.set(pictureOf(id), { image, facts: { least, greatest, window }, size: { width, height }, stated: frame.geometry });
  }

  /** Frames are shown undistorted from now on, or as they were taken. */
  useDistortion(distortion: Distortion | null): void {
    this.#undistorted.use(distortion);
  }

  /** Changes whenever frames look otherwise: what was painted or worked out from their pixels is of the past. */
  get framesKey(): string {
    return this.#undistorted.key;
  }

  /** What the file of a frame says of sizes and distances. */
  statedGeometry(id: string): StatedGeometry | null {
    return this.#frames.get(pictureOf(id))?.stated ?? null;
  }

  #shown(id: string): FrameImage | null {
    const held = this.#frames.get(pictureOf(id));
    return held ? this.#undistorted.shown(id, held.image, held.size) : null;
  }

  /** The frame in WASM memory, for tools that look at its pixels. */
  imageOf(id: string): FrameImage | null {
    return this.#shown(id);
  }

  hasFrame(id: string): boolean {
    return this.#frames.has(pictureOf(id));
  }

  frameFacts(id: string): FrameFacts | null {
    return this.#frames.get(pictureOf(id))?.facts ?? null;
  }

  paintFrame(context: CanvasRenderingContext2D, id: string, window: GreyWindow, preprocessing: Preprocessing = 'original'): void {
    const held = this.#frames.get(pictureOf(id));
    const image = this.#shown(id);
    if (held && image) paintPreprocessed(image, held.facts.window, context, window, preprocessing);
  }

  /** A copy of a frame's grey values, for a worker. */
  framePixels(id: string): FramePixels['pixels'] | null {
    return pixelsOf(this.#shown(id));
  }

  /** The same of the frame as it was taken, whether it is shown undistorted or not. */
  takenPixels(id: string): FramePixels['pixels'] | null {
    return pixelsOf(this.#frames.get(pictureOf(id))?.image ?? null);
  }

  greyAt(id: string, column: number, row: number): number | null {
    if (column < 0 || row < 0) return null;
    return this.#shown(id)?.greyAt(Math.floor(column), Math.floor(row)) ?? null;
  }

  // --- Models -------------------------------------------------------------------------------------------------

  addModel(sha256: string, mesh: ModelMesh): void {
    if (!this.#models.has(sha256)) this.#models.set(sha256, { mesh, model: new Model(mesh.vertices, mesh.triangles) });
  }

  meshOf(sha256: string): ModelMesh | null {
    return this.#models.get(sha256)?.mesh ?? null;
  }

  /**
   * What a person should know of a model as it was read, in sentences without their full stops: what was left out of its
   * file, holes, windings, a size that is no knee component's.
   */
  remarksOn(sha256: string): readonly string[] {
    const held = this.#models.get(sha256);
    if (!held) return [];
    held.remarks ??= [...(held.mesh.notes ?? []), ...held.model.remarks];
    return held.remarks;
  }

  /**
   * Finds the silhouette of a model at a pose: its border in frame coordinates, columns and rows by turns. What has holes
   * or more than one part is painted on the canvas too. Null without the model.
   */
  paintSilhouette(
    context: () => CanvasRenderingContext2D,
    sha256: string,
    camera: CameraInput,
    pose: PoseNumbers,
    rgb: number,
  ): PaintedSilhouette | null {
    const model = this.#models.get(sha256)?.model;
    if (!model) return null;
    const { text, width, height, distortion } = camera;
    model.project(text, width, height, Float64Array.from(poseArray(pose)));
    model.followBorder(width, height);
    const distorter = distortion ? this.#distorterOf(distortion) : null;
    distorter?.border(model);
    const box = model.borderIsWhole ? null : paintPicture(model, context(), camera, rgb, distorter);
    return { border: numbersAt(this.#memory, model.borderAddress, model.borderLength), box };
  }

  #distorterOf({ key, numbers }: DistortionInput): OverlayDistorter {
    if (this.#distorter?.key === key) return this.#distorter;
    this.#distorter?.free();
    return (this.#distorter = new OverlayDistorter(key, numbers));
  }

  paintUnmatched(context: CanvasRenderingContext2D, picture: Picture): void {
    paintUnmatched(context, picture.input, picture.view, picture.size);
  }

  /** Pixels nearer than this to a side that is marked unknown are ignored. */
  get unknownReach(): number {
    return unknownReach();
  }

  /** Throws the core's sentence for a library that is damaged, before it takes the place of a sound one. */
  checkLibrary(bytes: Uint8Array): void {
    checkLibrary(bytes);
  }

  // --- Texts --------------------------------------------------------------------------------------------------

  /** Throws the core's sentence for a text that is no calibration or does not fit the frames. */
  calibrationFacts(text: string, frame: Size | null): CalibrationFacts {
    const calibration = new CalibrationText(text);
    try {
      const principal = calibration.principal;
      const [fx, fy, cx, cy] = frame ? calibration.cameraFor(frame.width, frame.height) : [];
      const [principalDistance, offsetX, offsetY, pitch] = principal ?? [];
      return {
        principal:
          principalDistance === undefined || pitch === undefined
            ? null
            : { distance: principalDistance, offsetX: offsetX ?? 0, offsetY: offsetY ?? 0, pitch },
        camera: fx === undefined ? null : { fx, fy: fy ?? fx, cx: cx ?? 0, cy: cy ?? 0 },
      };
    } finally {
      calibration.free();
    }
  }

  /** Throws the core's sentence for a value that is not possible. */
  calibrationText(distance: number, offsetX: number, offsetY: number, pitch: number, frame: Size): string {
    return jtIntcalibText(distance, offsetX, offsetY, pitch, frame.width, frame.height);
  }

  /**
   * The camera of a bead plate: pitch and its deviation, principal point x and y from the middle and their deviations
   * (mm), 1 where the picture tells that point, tilt (degrees), residual (px), beads. Throws the core's sentence.
   */
  plateCamera(beads: Float64Array, spacing: number, toDetector: number, toPlate: number, frame: Size): Float64Array {
    return plateCamera(beads, spacing, toDetector, toPlate, frame.width, frame.height);
  }

  /** Length of a ruler in px, pitch in mm, focal length in px. Throws the core's sentence. */
  rulerScale(marks: readonly FramePoint[], length: number, toDetector: number, toRuler: number): Float64Array {
    const places = Float64Array.from(marks.flatMap(({ column, row }) => [column, row]));
    return rulerScale(places, length, toDetector, toRuler);
  }

  /** Null for a frame without a pose, which is six times NaN. */
  readPoses(text: string): (PoseNumbers | null)[] {
    const numbers = readJts(text);
    return Array.from({ length: numbers.length / 6 }, (_, row) => {
      const values = numbers.subarray(6 * row, 6 * row + 6);
      return values.some(Number.isNaN) ? null : poseFrom(values);
    });
  }

  /** The tibial component relative to the femoral one. */
  motionOf(femur: PlacedInJoint, tibia: PlacedInJoint, side: 'left' | 'right'): Motion {
    const [anterior = NaN, superior = NaN, lateral = NaN, flexion = NaN, abduction = NaN, internal = NaN] = jointMotion(
      Float64Array.from(poseArray(femur.pose)),
      numbersOf(femur.axes),
      Float64Array.from(poseArray(tibia.pose)),
      numbersOf(tibia.axes),
      side === 'left',
    );
    return { anterior, superior, lateral, flexion, abduction, internal };
  }

  writePoses(poses: readonly (PoseNumbers | null)[]): string {
    return writeJts(Float64Array.from(poses.flatMap((pose) => (pose ? poseArray(pose) : NO_POSE))));
  }
}

/** The part of the canvas that was painted. */
function paintPicture(model: Model, canvas: CanvasRenderingContext2D, { width, height }: Size, rgb: number, distorter: OverlayDistorter | null): Box {
  canvas.clearRect(0, 0, width, height);
  const [left = 0, top = 0, across = 0, down = 0] = model.paint(canvas, width, height, rgb);
  if (!distorter) return { left, top, width: across, height: down };
  distorter.picture(canvas, width, height);
  return { left: 0, top: 0, width, height };
}

function pixelsOf(image: FrameImage | null): FramePixels['pixels'] | null {
  return image && (image.copyPixels() as FramePixels['pixels']);
}

/** A frame without a pose keeps its row. */
const NO_POSE: readonly number[] = [NaN, NaN, NaN, NaN, NaN, NaN];
