import type { Preprocessing } from '../terms/seeing';
import type { Candidate, GreyWindow } from '../document/types';
import type { ComponentName } from '../terms/component';
import type { CameraInput } from '../workers/protocol/camera';
import type { Box, Studio } from '../films/studio';
import { framePoint, type FramePoint } from '../geometry/points';
import type { Size } from '../geometry/viewport';
import { COMPONENT_COLOURS } from '../controls/colours';

/** A canvas of the frame's own size, painted by WASM and kept until what it shows changes. */
abstract class Layer {
  readonly canvas = document.createElement('canvas');

  protected context({ width, height }: Size): CanvasRenderingContext2D {
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    const context = this.canvas.getContext('2d');
    if (!context) throw new Error('this browser has no 2-D canvas');
    return context;
  }
}

export class FrameLayer extends Layer {
  #id = '';
  #window: GreyWindow | null = null;
  #preprocessing: Preprocessing = 'original';
  #framesKey = '';

  update(studio: Studio, frame: { id: string; width: number; height: number }, window: GreyWindow, preprocessing: Preprocessing): void {
    const sameWindow = this.#window?.centre === window.centre && this.#window.width === window.width;
    const same = this.#id === frame.id && sameWindow && this.#preprocessing === preprocessing && this.#framesKey === studio.framesKey;
    if (same || !studio.holdsFrame(frame.id)) return;
    studio.paintFrame(this.context(frame), frame.id, window, preprocessing);
    this.#preprocessing = preprocessing;
    this.#framesKey = studio.framesKey;
    this.#id = frame.id;
    this.#window = window;
  }
}

/** The projected silhouette of one component. */
export class OverlayLayer extends Layer {
  /** In frame coordinates; null while there is nothing to show. */
  border: Path2D | null = null;
  /** Two opposite corners of the rectangle around the border; empty while there is none. */
  extent: readonly FramePoint[] = [];
  /** The part of the canvas that the silhouette is in; null where to fill the border is the same. */
  box: Box | null = null;
  #candidate: Candidate | null = null;
  #camera = '';
  #model = '';

  constructor(readonly component: ComponentName) {
    super();
  }

  /** Returns the sentence of what went wrong, if something did. */
  update(studio: Studio, camera: CameraInput | null, model: string | null, candidate: Candidate | null): string | null {
    if (!camera || !model || !candidate) {
      this.#candidate = null;
      this.border = null;
      this.extent = [];
      return null;
    }
    const cameraKey = `${camera.width}x${camera.height} ${camera.text} ${camera.distortion?.key ?? ''}`;
    if (candidate === this.#candidate && cameraKey === this.#camera && model === this.#model) return null;
    this.#candidate = candidate;
    this.#camera = cameraKey;
    this.#model = model;
    this.border = null;
    this.extent = [];
    try {
      const { rgb } = COMPONENT_COLOURS[this.component];
      const painted = studio.paintSilhouette(() => this.context(camera), model, camera, candidate.pose, rgb);
      this.border = painted && polygon(painted.border);
      this.extent = painted ? extentOf(painted.border) : [];
      this.box = painted && painted.box;
      return null;
    } catch (error) {
      return error instanceof Error ? error.message : String(error);
    }
  }
}

function extentOf(corners: Float64Array): FramePoint[] {
  let [left, top, right, bottom] = [Infinity, Infinity, -Infinity, -Infinity];
  for (let i = 0; i + 1 < corners.length; i += 2) {
    left = Math.min(left, corners[i]!);
    right = Math.max(right, corners[i]!);
    top = Math.min(top, corners[i + 1]!);
    bottom = Math.max(bottom, corners[i + 1]!);
  }
  return corners.length > 0 ? [framePoint(left, top), framePoint(right, bottom)] : [];
}

function polygon(corners: Float64Array): Path2D {
  const path = new Path2D();
  for (let i = 0; i + 1 < corners.length; i += 2) path.lineTo(corners[i]!, corners[i + 1]!);
  path.closePath();
  return path;
}
