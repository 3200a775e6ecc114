import { type Camera, CanvasTexture, Color, ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial, Quaternion, Sprite, SpriteMaterial, Vector3 } from 'three';
import type { Vector } from '../../geometry/pose_motion';
import type { ComponentName } from '../../terms/component';
import { COMPONENT_COLOURS } from '../../controls/colours';

/** A direction from the middle of a model, in the coordinates of its file. */
export interface Arrow {
  readonly direction: Vector;
  /** Null: the arrow alone. */
  readonly name: string | null;
}

/** Parts of an arrow's length, and of its name's height. */
const THICKNESS = 0.018;
const HEAD = 0.16;
const LETTERS = 0.28;

/** Arrows and their names lie over everything: what they say holds of a part's back, too. */
const ON_TOP = { depthTest: false, depthWrite: false, transparent: true };

/** Arrows of a model as long as its radius and a little more. */
export function arrowsOf(arrows: readonly Arrow[], middle: Vector, radius: number, component: ComponentName): Group {
  const group = new Group();
  group.userData['middle'] = middle;
  const length = 1.15 * radius;
  const color = new Color(COMPONENT_COLOURS[component].light);
  for (const { direction, name } of arrows) {
    const arrow = arrowAlongY(length, color);
    arrow.applyQuaternion(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), new Vector3(...direction)));
    arrow.position.set(...middle);
    group.add(arrow);
    if (name === null) continue;
    const sprite = nameSprite(name, LETTERS * radius);
    sprite.position.set(...middle).addScaledVector(new Vector3(...direction), length + 0.7 * LETTERS * radius);
    group.add(sprite);
  }
  return group;
}

function arrowAlongY(length: number, color: Color): Group {
  const material = new MeshBasicMaterial({ color, ...ON_TOP });
  const shaft = new Mesh(new CylinderGeometry(THICKNESS * length, THICKNESS * length, length, 8), material);
  shaft.position.y = length / 2;
  const head = new Mesh(new ConeGeometry((HEAD * length) / 3, HEAD * length, 16), material);
  head.position.y = length - (HEAD * length) / 2;
  const arrow = new Group().add(shaft, head);
  for (const part of [shaft, head]) part.renderOrder = 1;
  return arrow;
}

/** Drawn large, shown small: sharp at any distance. */
const FONT = 48;

function nameSprite(name: string, height: number): Sprite {
  const canvas = document.createElement('canvas');
  const font = `600 ${FONT}px system-ui, sans-serif`;
  const measure = canvas.getContext('2d');
  if (measure) measure.font = font;
  const width = Math.ceil((measure?.measureText(name).width ?? FONT * name.length) + 16);
  canvas.width = width;
  canvas.height = Math.ceil(1.3 * FONT);
  const context = canvas.getContext('2d');
  if (context) {
    Object.assign(context, { font, textBaseline: 'middle', lineWidth: 8, lineJoin: 'round', strokeStyle: '#0b0c0d', fillStyle: '#ffffff' });
    context.strokeText(name, 8, canvas.height / 2);
    context.fillText(name, 8, canvas.height / 2);
  }
  const sprite = new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas), ...ON_TOP }));
  sprite.scale.set((height * width) / canvas.height, height, 1);
  sprite.renderOrder = 2;
  return sprite;
}

/** Cosine between an arrow and where the eye looks from which its name is left out. */
const AT_THE_EYE = 0.94;

export function hideNamesTowards(group: Group, eye: Camera): void {
  const gaze = eye.getWorldDirection(new Vector3());
  const [middle, tip] = [new Vector3(), new Vector3()];
  for (const part of group.children) {
    if (!(part instanceof Sprite)) continue;
    middle.fromArray(group.userData['middle'] as Vector).applyMatrix4(group.matrix);
    tip.copy(part.position).applyMatrix4(group.matrix);
    part.visible = Math.abs(tip.sub(middle).normalize().dot(gaze)) < AT_THE_EYE;
  }
}

/** What the graphics card holds of them. */
export function letGo(group: Group): void {
  group.traverse((part) => {
    if (part instanceof Mesh) {
      part.geometry.dispose();
      (part.material as MeshBasicMaterial).dispose();
    } else if (part instanceof Sprite) {
      part.material.map?.dispose();
      part.material.dispose();
    }
  });
}
