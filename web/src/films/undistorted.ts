import { Straightener, type Film as FrameImage, type Model } from '../pkg/page/fluoropose_wasm.js';
import { type Distortion, distortionKey, fits, numbersOf } from '../document/distortion';
import type { MovePoints } from '../document/set_distortion';

/** Corrections at work on the page's own thread: for points, and for frames that are shown straight. */
export class UndistortedFrames {
  #distortion: Distortion | null = null;
  #key = '';
  #straightener: Straightener | null = null;
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
    this.#straightener?.free();
    this.#straightener = null;
    // Tools may still hold one of them: they are let go, not freed.
    this.#images.clear();
  }

  /** The frame as it is shown: straight, where the correction is for frames of its size. */
  shown(id: string, image: FrameImage, size: { readonly width: number; readonly height: number }): FrameImage {
    const distortion = this.#distortion;
    if (!fits(distortion, size)) return image;
    const known = this.#images.get(id);
    if (known) return known;
    this.#straightener ??= new Straightener(numbersOf(distortion));
    const straight = this.#straightener.film(image);
    this.#images.set(id, straight);
    return straight;
  }
}

/** Points of frames as taken to where they lie once straight. */
export function straightening(distortion: Distortion): MovePoints {
  return (points) => withStraightener(distortion, (straightener) => straightener.straight(points));
}

/** The way back. */
export function bending(distortion: Distortion): MovePoints {
  return (points) => withStraightener(distortion, (straightener) => straightener.bent(points));
}

/** Throws the core's sentence for numbers that are no correction. */
export function checkDistortion(distortion: Distortion): void {
  withStraightener(distortion, () => undefined);
}

function withStraightener<T>(distortion: Distortion, work: (straightener: Straightener) => T): T {
  const straightener = new Straightener(numbersOf(distortion));
  try {
    return work(straightener);
  } finally {
    straightener.free();
  }
}

/** Overlays are drawn straight; on frames that stay as they were taken they are bent likewise. */
export class Bender {
  readonly #straightener: Straightener;
  #sources: Uint32Array | null = null;

  constructor(readonly key: string, numbers: Float64Array) {
    this.#straightener = new Straightener(numbers);
  }

  border(model: Model): void {
    model.bendBorder(this.#straightener);
  }

  /** Moves what was painted, pixel by pixel. */
  picture(context: CanvasRenderingContext2D, width: number, height: number): void {
    const sources = (this.#sources ??= this.#straightener.sources());
    const painted = new Uint32Array(context.getImageData(0, 0, width, height).data.buffer);
    const bent = new ImageData(width, height);
    const out = new Uint32Array(bent.data.buffer);
    // One past the last pixel stands for nowhere: undefined becomes 0, nothing painted.
    sources.forEach((source: number, index: number) => (out[index] = painted[source] ?? 0));
    context.putImageData(bent, 0, 0);
  }

  free(): void {
    this.#straightener.free();
  }
}
