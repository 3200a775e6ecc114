import { Undistorter, type FrameImage, type Model } from '../pkg/page/fluoropose_page.js';
import { type Distortion, distortionKey, fits, numbersOf } from '../document/distortion';
import type { MovePoints } from '../document/set_distortion';

/** Undistorted frames that are kept: each is as large as the frame itself. */
const KEPT = 16;

/** Corrections at work on the page's own thread: for points, and for frames that are shown undistorted. */
export class UndistortedFrames {
  #distortion: Distortion | null = null;
  #key = '';
  #undistorter: Undistorter | null = null;
  readonly #images = new Map<string, FrameImage>();

  /** Changes whenever frames look otherwise. */
  get key(): string {
    return this.#key;
  }

  use(distortion: Distortion | null): void {
    const shown = distortion?.appliesTo === 'frames' ? distortion : null;
    if (shown === this.#distortion) return;
    this.#distortion = shown;
    const key = distortionKey(shown);
    if (key === this.#key) return;
    this.#key = key;
    this.#undistorter?.free();
    this.#undistorter = null;
    // Tools may still hold one of them: they are let go, not freed.
    this.#images.clear();
  }

  /** The frame as it is shown: undistorted, where the correction is for frames of its size. */
  shown(id: string, image: FrameImage, size: { readonly width: number; readonly height: number }): FrameImage {
    const distortion = this.#distortion;
    if (!fits(distortion, size)) return image;
    const known = this.#images.get(id);
    this.#images.delete(id);
    this.#undistorter ??= new Undistorter(numbersOf(distortion));
    const undistorted = known ?? this.#undistorter.frame(image);
    // The one that was used last comes last.
    this.#images.set(id, undistorted);
    const [oldest] = this.#images.keys();
    if (oldest !== undefined && this.#images.size > KEPT) this.#letGo(oldest);
    return undistorted;
  }

  /** Nobody has used it for long. */
  #letGo(id: string): void {
    this.#images.get(id)?.free();
    this.#images.delete(id);
  }
}

/** Points of frames as taken to where they lie in the undistorted frame. */
export function undistorting(distortion: Distortion): MovePoints {
  return (points) => withUndistorter(distortion, (undistorter) => undistorter.undistorted(points));
}

/** The way back. */
export function distorting(distortion: Distortion): MovePoints {
  return (points) => withUndistorter(distortion, (undistorter) => undistorter.distorted(points));
}

/** Throws the core's sentence for numbers that are no correction. */
export function checkDistortion(distortion: Distortion): void {
  withUndistorter(distortion, () => undefined);
}

function withUndistorter<T>(distortion: Distortion, work: (undistorter: Undistorter) => T): T {
  const undistorter = new Undistorter(numbersOf(distortion));
  try {
    return work(undistorter);
  } finally {
    undistorter.free();
  }
}

/** Overlays are drawn undistorted; on frames that stay as they were taken they are distorted likewise. */
export class OverlayDistorter {
  readonly #undistorter: Undistorter;
  #sources: Uint32Array | null = null;

  constructor(readonly key: string, numbers: Float64Array) {
    this.#undistorter = new Undistorter(numbers);
  }

  border(model: Model): void {
    model.distortBorder(this.#undistorter);
  }

  /** Moves what was painted, pixel by pixel. */
  picture(context: CanvasRenderingContext2D, width: number, height: number): void {
    const sources = (this.#sources ??= this.#undistorter.sources());
    const painted = new Uint32Array(context.getImageData(0, 0, width, height).data.buffer);
    const distorted = new ImageData(width, height);
    const out = new Uint32Array(distorted.data.buffer);
    // One past the last pixel stands for nowhere: undefined becomes 0, nothing painted.
    sources.forEach((source: number, index: number) => (out[index] = painted[source] ?? 0));
    context.putImageData(distorted, 0, 0);
  }

  free(): void {
    this.#undistorter.free();
  }
}
