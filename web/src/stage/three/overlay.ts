import { PerspectiveCamera, WebGLRenderer } from 'three';
import type { Pinhole } from '../../geometry/pose_motion';
import type { Size, Viewport } from '../../geometry/viewport';
import { ModelScene, type PlacedModel } from './models';

/** Nothing nearer to the focus than this is drawn, nor anything beyond, mm. */
const NEAR = 10;
const FAR = 10_000;

/** Models as the X-ray's camera sees them, shaded, to lie on the frame. */
export class ShadedOverlay {
  readonly #renderer = new WebGLRenderer({ alpha: true, antialias: true });
  readonly #models = new ModelScene();
  readonly #camera = new PerspectiveCamera();

  /** A picture as large as the canvas; it holds until the next one. */
  draw(models: readonly PlacedModel[], pinhole: Pinhole, view: Viewport, size: Size, ratio: number): HTMLCanvasElement {
    this.#renderer.setPixelRatio(ratio);
    this.#renderer.setSize(size.width, size.height, false);
    this.#camera.projectionMatrix.set(...projection(onCanvas(pinhole, view), size));
    this.#camera.projectionMatrixInverse.copy(this.#camera.projectionMatrix).invert();
    this.#models.show(models);
    this.#renderer.render(this.#models.scene, this.#camera);
    return this.#renderer.domElement;
  }
}

/** The same camera with the canvas for its frame. */
function onCanvas({ fx, fy, cx, cy }: Pinhole, { scale, left, top }: Viewport): Pinhole {
  return { fx: fx * scale, fy: fy * scale, cx: cx * scale + left, cy: cy * scale + top };
}

type Rows = Parameters<PerspectiveCamera['projectionMatrix']['set']>;

/**
 * From `column = cx + fx X / -Z` and `row = cy - fy Y / -Z` to the cube of -1 to 1 that is drawn: `w = -Z`,
 * `x w = 2 column w / width - w`, `y w = w - 2 row w / height`. Rows of the matrix.
 */
export function projection({ fx, fy, cx, cy }: Pinhole, { width, height }: Size): Rows {
  const depth = FAR - NEAR;
  return [
    (2 * fx) / width, 0, 1 - (2 * cx) / width, 0,
    0, (2 * fy) / height, (2 * cy) / height - 1, 0,
    0, 0, -(FAR + NEAR) / depth, (-2 * FAR * NEAR) / depth,
    0, 0, -1, 0,
  ];
}
