import { PerspectiveCamera, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { inCamera, type Vector } from '../../geometry/pose_motion';
import { middleOf, ModelScene, radiusOf, type PlacedModel } from './models';

/** Where one looks from, with what is upwards there, in the camera's frame. */
export interface Viewpoint {
  readonly from: Vector;
  readonly up: Vector;
}

const AS_THE_CAMERA: Viewpoint = { from: [0, 0, 1], up: [0, 1, 0] };

const FIELD_OF_VIEW = 30;

/** Models in space, to be turned with the mouse or by keys. Drawn when something changes, never else. */
export class SpaceView {
  readonly #renderer: WebGLRenderer;
  readonly #models = new ModelScene();
  readonly #camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 1, 10_000);
  readonly #controls: OrbitControls;
  readonly #canvas: HTMLCanvasElement;
  #isFirst = true;
  #radius = 50;
  #scheduled = 0;

  constructor(canvas: HTMLCanvasElement) {
    this.#canvas = canvas;
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.#controls = new OrbitControls(this.#camera, canvas);
    this.#controls.enableDamping = false;
    this.#controls.enablePan = false;
    this.#controls.addEventListener('change', () => this.#schedule());
  }

  /** All of them are in sight, and turn about what lies between them. */
  show(models: readonly PlacedModel[]): void {
    if (models.length === 0) return;
    this.#models.show(models);
    const middles = models.map(({ mesh, pose }) => new Vector3(...inCamera(pose, middleOf(mesh))));
    const target = middles.reduce((sum, middle) => sum.add(middle), new Vector3()).divideScalar(models.length);
    this.#camera.position.add(target.clone().sub(this.#controls.target));
    this.#controls.target.copy(target);
    this.#radius = Math.max(...models.map((model, at) => reachOf(model) + target.distanceTo(middles[at]!)));
    if (this.#isFirst) this.look(AS_THE_CAMERA);
    this.#isFirst = false;
    this.#controls.update();
    this.#schedule();
  }

  look({ from, up }: Viewpoint): void {
    const away = this.#radius / Math.sin((FIELD_OF_VIEW * Math.PI) / 360);
    this.#camera.up.fromArray(up);
    this.#camera.position.copy(this.#controls.target).addScaledVector(new Vector3().fromArray(from), away);
    this.#camera.lookAt(this.#controls.target);
    this.#controls.update();
    this.#schedule();
  }

  /** Goes around what is looked at, degrees to the right and upwards. */
  turn(right: number, up: number): void {
    const axisUp = this.#camera.up.clone().normalize();
    const offset = this.#camera.position.clone().sub(this.#controls.target);
    const across = new Vector3().crossVectors(axisUp, offset).normalize();
    offset.applyAxisAngle(axisUp, (right * Math.PI) / 180).applyAxisAngle(across, (-up * Math.PI) / 180);
    this.#camera.position.copy(this.#controls.target).add(offset);
    this.#controls.update();
    this.#schedule();
  }

  dispose(): void {
    cancelAnimationFrame(this.#scheduled);
    this.#controls.dispose();
    this.#renderer.dispose();
  }

  #schedule(): void {
    this.#scheduled ||= requestAnimationFrame(() => {
      this.#scheduled = 0;
      const { clientWidth: width, clientHeight: height } = this.#canvas;
      if (width === 0 || height === 0) return;
      this.#renderer.setPixelRatio(window.devicePixelRatio || 1);
      this.#renderer.setSize(width, height, false);
      this.#camera.aspect = width / height;
      this.#camera.updateProjectionMatrix();
      this.#models.faceEye(this.#camera);
      this.#renderer.render(this.#models.scene, this.#camera);
    });
  }
}

/** How far a model with its arrows and their names reaches from its middle, mm. */
function reachOf({ mesh, arrows = [] }: PlacedModel): number {
  const named = arrows.some(({ name }) => name !== null);
  return radiusOf(mesh) * (named ? 1.5 : arrows.length > 0 ? 1.2 : 1.05);
}
