import init, { type FrameImage, Model, Undistorter } from '../../pkg/page/fluoropose_page.js';
import address from '../../pkg/page/fluoropose_page_bg.wasm?url';
import type { GreyWindow } from '../../document/types';
import { followBorder } from '../../painting/border';
import { paintPreprocessed } from '../../painting/preprocessing';
import { takenFrame } from '../../painting/taken_frame';
import { numbersAt } from '../../painting/wasm_view';
import type { OverlayFrame, OverlayModel } from '../protocol/overlay';

/** A frame as it is shown, and what lies on it. */
export interface ShownFrame {
  readonly picture: OffscreenCanvas;
  /** Columns and rows of an outline's corners by turns. */
  readonly outlines: readonly { readonly colour: string; readonly corners: Float64Array }[];
}

interface HeldModel {
  readonly colour: string;
  readonly model: Model;
}

/** Paints frames and finds outlines as the page does, by the page's own module. */
export class OverlayFrames {
  readonly #memory: WebAssembly.Memory;
  readonly #canvas = new OffscreenCanvas(1, 1);
  readonly #models: ReadonlyMap<string, HeldModel>;
  #undistorter: { readonly key: string; readonly made: Undistorter } | null = null;

  private constructor(memory: WebAssembly.Memory, models: readonly OverlayModel[]) {
    this.#memory = memory;
    this.#models = new Map(models.map(({ component, colour, mesh }) => [component, { colour, model: new Model(mesh.vertices, mesh.triangles) }]));
  }

  static async open(models: readonly OverlayModel[]): Promise<OverlayFrames> {
    const { memory } = await init({ module_or_path: address });
    return new OverlayFrames(memory, models);
  }

  shown(frame: OverlayFrame): ShownFrame {
    this.#paint(frame);
    return { picture: this.#canvas, outlines: this.#outlines(frame) };
  }

  #paint({ frame, window, preprocessing, undistorted }: OverlayFrame): void {
    const taken = takenFrame(frame);
    const image = undistorted ? this.#undistorterOf(undistorted).frame(taken) : taken;
    const suggested = frame.window ?? windowOf(taken);
    this.#canvas.width = frame.width;
    this.#canvas.height = frame.height;
    try {
      // The module asks a canvas for what canvases of either kind have.
      paintPreprocessed(image, suggested, contextOf(this.#canvas) as unknown as CanvasRenderingContext2D, window ?? suggested, preprocessing);
    } finally {
      if (image !== taken) image.free();
      taken.free();
    }
  }

  #outlines({ poses, camera }: OverlayFrame): ShownFrame['outlines'] {
    return poses.flatMap(({ component, pose }) => {
      const held = this.#models.get(component);
      if (!held || !camera) return [];
      const { colour, model } = held;
      const { distortion } = camera;
      followBorder(model, camera, pose, distortion ? { border: (model) => model.distortBorder(this.#undistorterOf(distortion)) } : null);
      return [{ colour, corners: numbersAt(this.#memory, model.borderAddress, model.borderLength).slice() }];
    });
  }

  #undistorterOf({ key, numbers }: NonNullable<OverlayFrame['undistorted']>): Undistorter {
    if (this.#undistorter?.key !== key) {
      this.#undistorter?.made.free();
      this.#undistorter = null;
      this.#undistorter = { key, made: new Undistorter(numbers) };
    }
    return this.#undistorter.made;
  }
}

function windowOf(image: FrameImage): GreyWindow {
  const [, , centre = 128, width = 256] = image.greyRange();
  return { centre, width };
}

function contextOf(canvas: OffscreenCanvas): OffscreenCanvasRenderingContext2D {
  const context = canvas.getContext('2d');
  if (!context) throw new Error('this browser has no 2-D canvas');
  return context;
}
