import {
  BufferAttribute,
  BufferGeometry,
  type Camera,
  Color,
  DirectionalLight,
  DoubleSide,
  type Group,
  HemisphereLight,
  Matrix4,
  Mesh,
  MeshPhongMaterial,
  Scene,
} from 'three';
import { arrowsOf, hideNamesTowards, letGo, type Arrow } from './arrows';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import type { ComponentName } from '../../terms/component';
import type { ModelMesh } from '../../workers/protocol/decode';
import { rotationOf, type Vector } from '../../geometry/pose_motion';
import { COMPONENT_COLOURS } from '../../controls/colours';

/** A model where it is. The camera frame of the project is that of three: x right, y up, looking along -z, mm. */
export interface PlacedModel {
  readonly component: ComponentName;
  readonly mesh: ModelMesh;
  readonly pose: PoseNumbers;
  /** From its middle. */
  readonly arrows?: readonly Arrow[];
}

const geometries = new WeakMap<ModelMesh, BufferGeometry>();

/** The scene with its light; models come and go. */
export class ModelScene {
  readonly scene = new Scene();
  readonly #meshes = new Map<ComponentName, Mesh>();
  readonly #arrows = new Map<ComponentName, { readonly of: string; readonly group: Group }>();

  constructor() {
    this.scene.add(new HemisphereLight(0xffffff, 0x555b63, 1.6));
    // Over the left shoulder of whoever looks from the X-ray's focus.
    const lamp = new DirectionalLight(0xffffff, 2.2);
    lamp.position.set(-0.5, 0.8, 1);
    this.scene.add(lamp);
  }

  show(models: readonly PlacedModel[]): void {
    const wanted = new Set(models.map(({ component }) => component));
    for (const [component, mesh] of this.#meshes) mesh.visible = wanted.has(component);
    for (const component of this.#arrows.keys()) if (!wanted.has(component)) this.#dropArrows(component);
    for (const model of models) {
      const mesh = this.#meshOf(model.component);
      mesh.geometry = geometryOf(model.mesh);
      mesh.matrix.copy(matrixOf(model.pose));
      mesh.matrixWorldNeedsUpdate = true;
      this.#showArrows(model, mesh.matrix);
    }
  }

  #showArrows({ component, mesh, arrows = [] }: PlacedModel, matrix: Matrix4): void {
    const of = JSON.stringify(arrows);
    if (this.#arrows.get(component)?.of !== of) {
      this.#dropArrows(component);
      const group = arrowsOf(arrows, middleOf(mesh), radiusOf(mesh), component);
      group.matrixAutoUpdate = false;
      this.scene.add(group);
      this.#arrows.set(component, { of, group });
    }
    const group = this.#arrows.get(component)?.group;
    group?.matrix.copy(matrix);
    if (group) group.matrixWorldNeedsUpdate = true;
  }

  /** A name whose arrow points at the eye, or away from it, would lie on the model. */
  faceEye(eye: Camera): void {
    for (const { group } of this.#arrows.values()) hideNamesTowards(group, eye);
  }

  #dropArrows(component: ComponentName): void {
    const group = this.#arrows.get(component)?.group;
    if (!group) return;
    this.scene.remove(group);
    letGo(group);
    this.#arrows.delete(component);
  }

  #meshOf(component: ComponentName): Mesh {
    const known = this.#meshes.get(component);
    if (known) return known;
    // Facets as they are; files of the field mix the winding of their triangles.
    const color = new Color(COMPONENT_COLOURS[component].css);
    const material = new MeshPhongMaterial({ color, flatShading: true, side: DoubleSide, shininess: 40 });
    const mesh = new Mesh(new BufferGeometry(), material);
    mesh.matrixAutoUpdate = false;
    mesh.frustumCulled = false;
    this.scene.add(mesh);
    this.#meshes.set(component, mesh);
    return mesh;
  }
}

function geometryOf(mesh: ModelMesh): BufferGeometry {
  const known = geometries.get(mesh);
  if (known) return known;
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(mesh.vertices, 3));
  geometry.setIndex(new BufferAttribute(mesh.triangles, 1));
  geometry.computeBoundingSphere();
  geometries.set(mesh, geometry);
  return geometry;
}

/** How large a model is: the radius of a ball around it, mm. */
export function radiusOf(mesh: ModelMesh): number {
  return geometryOf(mesh).boundingSphere?.radius ?? 1;
}

/** The middle of that ball, in the model's own coordinates. */
export function middleOf(mesh: ModelMesh): Vector {
  const { center } = geometryOf(mesh).boundingSphere ?? { center: { x: 0, y: 0, z: 0 } };
  return [center.x, center.y, center.z];
}

function matrixOf(pose: PoseNumbers): Matrix4 {
  const [a, b, c] = rotationOf(pose);
  return new Matrix4().set(...a, pose.x, ...b, pose.y, ...c, pose.z, 0, 0, 0, 1);
}
