import type { FilmLook } from '../document/seeing';
import type { Candidate, ComponentName, GreyWindow } from '../document/types';
import type { CameraInput } from '../engine/protocol';
import type { Box, Studio } from '../engine/studio';
import { COMPONENT_COLOURS } from './colours';

/** A canvas of the frame's own size, painted by WASM and kept until what it shows changes. */
abstract class Layer {
  readonly canvas = document.createElement('canvas');
  readonly context: CanvasRenderingContext2D;

  constructor() {
    const context = this.canvas.getContext('2d');
    if (!context) throw new Error('this browser has no 2-D canvas');
    this.context = context;
  }

  protected resize(width: number, height: number): void {
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
  }
}

export class FilmLayer extends Layer {
  #id = '';
  #window: GreyWindow | null = null;
  #look: FilmLook = 'original';
  #films = '';

  update(studio: Studio, frame: { id: string; width: number; height: number }, window: GreyWindow, look: FilmLook): void {
    const sameWindow = this.#window?.centre === window.centre && this.#window.width === window.width;
    const same = this.#id === frame.id && sameWindow && this.#look === look && this.#films === studio.filmsKey;
    if (same || !studio.hasFilm(frame.id)) return;
    this.resize(frame.width, frame.height);
    studio.paintFilm(this.context, frame.id, window, look);
    this.#look = look;
    this.#films = studio.filmsKey;
    this.#id = frame.id;
    this.#window = window;
  }
}

/** The projected silhouette of one component. */
export class OverlayLayer extends Layer {
  /** In frame coordinates; null while there is nothing to show. */
  border: Path2D | null = null;
  /** The part of the canvas that the silhouette is in. */
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
      return null;
    }
    const cameraKey = `${camera.width}x${camera.height} ${camera.text} ${camera.bend?.key ?? ''}`;
    if (candidate === this.#candidate && cameraKey === this.#camera && model === this.#model) return null;
    this.#candidate = candidate;
    this.#camera = cameraKey;
    this.#model = model;
    this.border = null;
    this.resize(camera.width, camera.height);
    try {
      const { rgb } = COMPONENT_COLOURS[this.component];
      const painted = studio.paintSilhouette(this.context, model, camera, candidate.pose, rgb);
      this.border = painted && polygon(painted.border);
      this.box = painted && painted.box;
      return null;
    } catch (error) {
      return error instanceof Error ? error.message : String(error);
    }
  }
}

function polygon(corners: Float64Array): Path2D {
  const path = new Path2D();
  for (let i = 0; i + 1 < corners.length; i += 2) path.lineTo(corners[i]!, corners[i + 1]!);
  path.closePath();
  return path;
}
