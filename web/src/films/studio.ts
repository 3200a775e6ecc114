import { pictureOf } from '../document/same_frames';
import init, {
  CalibrationText,
  type FrameImage,
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
import type { ComponentName } from '../terms/component';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { Distortion } from '../document/distortion';
import type { FramePoint } from '../geometry/points';
import type { Size } from '../geometry/viewport';
import type { Motion, PlacedInJoint } from '../results/motion';
import { Aborted } from '../workers/bridge';
import { poseArray, poseFrom } from '../workers/protocol/pose_array';
import { followBorder } from '../painting/border';
import { paintPreprocessed } from '../painting/preprocessing';
import { takenFrame } from '../painting/taken_frame';
import { numbersAt } from '../painting/wasm_view';
import type { Preprocessing } from '../terms/seeing';
import type { FramePixels } from '../workers/protocol/frame_pixels';
import type { Picture } from '../workers/protocol/match';
import type { DecodedFrame, ModelMesh, ShapeFacts, StatedGeometry } from '../workers/protocol/decode';
import type { DistortionInput, CalibrationFacts, CameraInput } from '../workers/protocol/camera';
import type { DecodeFrame, FrameSource } from './decoding';
import { type Held, LeasedFrames } from './leased_frames';
import { OverlayDistorter, UndistortedFrames } from './undistorted';

/** Grey values of a frame, and the window to begin with. */
export interface FrameFacts {
  readonly least: number;
  readonly greatest: number;
  readonly window: GreyWindow;
}

/** A frame that can be had, and what is known of it since it was last in memory. */
interface KnownFrame {
  readonly source: FrameSource;
  facts: FrameFacts | null;
  stated: StatedGeometry | null;
}

interface HeldFrame extends Held {
  /** As it was taken. */
  readonly image: FrameImage;
  readonly size: Size;
}

/** Frames that are not on view are kept in so much memory, bytes; 128 of 1024 x 1024 at 16 bits. */
const BUDGET = 256 << 20;

interface HeldModel {
  readonly mesh: ModelMesh;
  readonly model: Model;
  readonly shape: ShapeFacts;
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
  /** By what frames that look alike have in common. */
  readonly #known = new Map<string, KnownFrame>();
  readonly #frames: LeasedFrames<HeldFrame>;
  readonly #decode: DecodeFrame;
  /** Called when a frame has come into memory that was expected. */
  onArrival: () => void = () => undefined;
  /** Called when one could not be read. */
  onTrouble: (error: unknown) => void = () => undefined;
  readonly #undistorted = new UndistortedFrames();
  #distorter: OverlayDistorter | null = null;
  /** By the file's SHA-256: undo may go back to an earlier one. */
  readonly #models = new Map<string, HeldModel>();

  private constructor(memory: WebAssembly.Memory, decode: DecodeFrame) {
    this.#memory = memory;
    this.#decode = decode;
    this.#frames = new LeasedFrames(BUDGET, async (id, signal) => {
      const known = this.#known.get(id);
      const frame = known ? await decode(known.source, signal) : null;
      return known && frame ? this.#taken(known, frame) : null;
    });
  }

  static async open(decode: DecodeFrame): Promise<Studio> {
    const { memory } = await init({ module_or_path: wasmAddress });
    return new Studio(memory, decode);
  }

  // --- Frames -------------------------------------------------------------------------------------------------

  /** A frame that was just decoded, and where to have it from when it is no longer in memory. */
  addFrame(id: string, source: FrameSource, frame: DecodedFrame): void {
    const known = this.knowFrame(id, source);
    if (!this.#frames.has(pictureOf(id))) this.#frames.put(pictureOf(id), this.#taken(known, frame));
  }

  /** A frame whose file is at hand. */
  knowFrame(id: string, source: FrameSource): KnownFrame {
    const picture = pictureOf(id);
    const known = this.#known.get(picture) ?? { source, facts: null, stated: null };
    this.#known.set(picture, known);
    return known;
  }

  /** How many frames can be had. */
  get known(): number {
    return this.#known.size;
  }

  #taken(known: KnownFrame, frame: DecodedFrame): HeldFrame {
    const { pixels, width, height, window: stated, geometry } = frame;
    const image = takenFrame(frame);
    const [least = 0, greatest = 255, centre = 128, windowWidth = 256] = image.greyRange();
    known.facts = { least, greatest, window: stated ?? { centre, width: windowWidth } };
    known.stated = geometry;
    return { image, size: { width, height }, bytes: pixels.byteLength, free: () => image.free() };
  }

  /** Brings what is on view, which comes first and stays, and what will soon be. */
  expect(ids: readonly string[]): void {
    const pictures = ids.map(pictureOf);
    const [onView] = pictures;
    const isHere = onView === undefined || this.#frames.has(onView);
    // Of one that is not known yet the answer would be none, also to who asks in the same moment after it has become known.
    this.#frames.expect(pictures.filter((picture) => this.#known.has(picture))).then(
      () => isHere || this.onArrival(),
      (error: unknown) => {
        // Another one is on view by now.
        if (error instanceof Aborted || onView === undefined) return;
        // What cannot be read is not at hand, and that is said where it would be shown.
        this.#known.delete(onView);
        this.onTrouble(error);
      },
    );
  }

  /** Waits until a frame is in memory; false where its file is not at hand. */
  async bring(id: string): Promise<boolean> {
    return this.hasFrame(id) && (await this.#frames.bring(pictureOf(id))) !== null;
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
    return this.#known.get(pictureOf(id))?.stated ?? null;
  }

  #shown(id: string): FrameImage | null {
    const held = this.#frames.get(pictureOf(id));
    return held ? this.#undistorted.shown(id, held.image, held.size) : null;
  }

  /** The frame in WASM memory, for tools that look at its pixels; null while it is not there. */
  imageOf(id: string): FrameImage | null {
    return this.#shown(id);
  }

  /** Can it be had? */
  hasFrame(id: string): boolean {
    return this.#known.has(pictureOf(id));
  }

  /** Is it in memory? */
  holdsFrame(id: string): boolean {
    return this.#frames.has(pictureOf(id));
  }

  /** Null before it was first in memory. */
  frameFacts(id: string): FrameFacts | null {
    return this.#known.get(pictureOf(id))?.facts ?? null;
  }

  paintFrame(context: CanvasRenderingContext2D, id: string, window: GreyWindow, preprocessing: Preprocessing = 'original'): void {
    const facts = this.frameFacts(id);
    const image = this.#shown(id);
    if (facts && image) paintPreprocessed(image, facts.window, context, window, preprocessing);
  }

  /** A copy of a frame's grey values, for a worker; null where its file is not at hand. */
  async framePixels(id: string): Promise<FramePixels | null> {
    await this.bring(id);
    const image = this.#shown(id);
    const held = this.#frames.get(pictureOf(id));
    return image && held && { ...held.size, pixels: pixelsOf(image), covered: image.covered as FramePixels['covered'] };
  }

  /** The same of the frame as it was taken, whether it is shown undistorted or not. */
  async takenPixels(id: string): Promise<FramePixels['pixels'] | null> {
    await this.bring(id);
    const held = this.#frames.get(pictureOf(id));
    return held ? pixelsOf(held.image) : null;
  }

  /** A frame anew from its file, as it was taken, for a worker to have; null where its file is not at hand. */
  async decoded(id: string, signal: AbortSignal): Promise<DecodedFrame | null> {
    const known = this.#known.get(pictureOf(id));
    return known ? this.#decode(known.source, signal) : null;
  }

  greyAt(id: string, column: number, row: number): number | null {
    if (column < 0 || row < 0) return null;
    return this.#shown(id)?.greyAt(Math.floor(column), Math.floor(row)) ?? null;
  }

  // --- Models -------------------------------------------------------------------------------------------------

  addModel(sha256: string, mesh: ModelMesh, shape: ShapeFacts): void {
    if (!this.#models.has(sha256)) this.#models.set(sha256, { mesh, shape, model: new Model(mesh.vertices, mesh.triangles) });
  }

  meshOf(sha256: string): ModelMesh | null {
    return this.#models.get(sha256)?.mesh ?? null;
  }

  /** The component that a model has the shape of; null where that does not tell, or it is not here. */
  shapeOf(sha256: string): ComponentName | null {
    return this.#models.get(sha256)?.shape.component ?? null;
  }

  /**
   * What a person should know of a model as it was read, in sentences without their full stops: what was left out of its
   * file, holes, windings, a size that is no knee component's.
   */
  remarksOn(sha256: string): readonly string[] {
    const held = this.#models.get(sha256);
    if (!held) return [];
    return [...(held.mesh.notes ?? []), ...held.shape.remarks];
  }

  /** Millimetres in a unit of a model's file, where its size is a knee component's in other units alone. */
  suspectedUnitsOf(sha256: string): readonly number[] {
    return Array.from(this.#models.get(sha256)?.model.suspectedUnits ?? []);
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
    const { distortion } = camera;
    const distorter = distortion ? this.#distorterOf(distortion) : null;
    followBorder(model, camera, pose, distorter);
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

  // --- Texts --------------------------------------------------------------------------------------------------

  /** Whether a calibration is in a form of others, which the worker of poses brings into one that is read here. */
  isCalibrationOfOthers(text: string): boolean {
    return !CalibrationText.isOwn(text);
  }

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

function pixelsOf(image: FrameImage): FramePixels['pixels'] {
  return image.copyPixels() as FramePixels['pixels'];
}

/** A frame without a pose keeps its row. */
const NO_POSE: readonly number[] = [NaN, NaN, NaN, NaN, NaN, NaN];
