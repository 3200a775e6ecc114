/** Corners of a surface, x, y and z by turns, and the three of each triangle. */
interface Mesh {
  readonly vertices: Float32Array;
  readonly triangles: Uint32Array;
}

/** What a knee component looks like: a tray is a plate, a femoral component a bow. */
export type ShapeKind = 'tray' | 'bow';

const kinds = new WeakMap<Mesh, ShapeKind | null>();

/** Null where the shape is clearly neither. */
export function shapeKindOf(mesh: Mesh): ShapeKind | null {
  let kind = kinds.get(mesh);
  if (kind === undefined) kinds.set(mesh, (kind = kindBy(plateFraction(mesh))));
  return kind;
}

const PLATE = 0.42;
const NO_PLATE = 0.34;

function kindBy(fraction: number): ShapeKind | null {
  if (fraction > PLATE) return 'tray';
  return fraction < NO_PLATE ? 'bow' : null;
}

/** A face looks in a direction where its normal lies within 15 degrees of that or its opposite; a cosine. */
const WITHIN = 0.966;
/** Directions of half a sphere that are tried: one lies within ten degrees of any. */
const TRIED = 150;

/** The greatest part of the surface that faces one direction or its opposite. */
export function plateFraction(mesh: Mesh): number {
  const normals = normalsOf(mesh);
  let [area, most] = [0, 0];
  for (let at = 0; at < normals.length; at += 3) area += lengthOf(normals, at);
  for (let number = 0; number < TRIED; number++) {
    const begin = direction(number);
    most = Math.max(most, facing(normals, facing(normals, begin).middle).area);
  }
  return area > 0 ? most / area : 0;
}

type Triple = readonly [number, number, number];

/** Of half a sphere, by the golden angle. */
function direction(number: number): Triple {
  const z = (number + 0.5) / TRIED;
  const around = number * Math.PI * (3 - Math.sqrt(5));
  const r = Math.sqrt(1 - z * z);
  return [r * Math.cos(around), r * Math.sin(around), z];
}

/** Doubled area of the faces that look in a direction, and the direction that they look in on the whole. */
function facing(normals: Float64Array, [a, b, c]: Triple): { readonly area: number; readonly middle: Triple } {
  let [area, x, y, z] = [0, 0, 0, 0];
  for (let at = 0; at < normals.length; at += 3) {
    const along = a * normals[at]! + b * normals[at + 1]! + c * normals[at + 2]!;
    const length = lengthOf(normals, at);
    if (Math.abs(along) < WITHIN * length) continue;
    const sign = Math.sign(along);
    area += length;
    x += sign * normals[at]!;
    y += sign * normals[at + 1]!;
    z += sign * normals[at + 2]!;
  }
  const length = Math.hypot(x, y, z) || 1;
  return { area, middle: [x / length, y / length, z / length] };
}

function lengthOf(normals: Float64Array, at: number): number {
  return Math.sqrt(normals[at]! ** 2 + normals[at + 1]! ** 2 + normals[at + 2]! ** 2);
}

/** Normals of the faces, as long as their doubled areas. */
function normalsOf({ vertices, triangles }: Mesh): Float64Array {
  const normals = new Float64Array(triangles.length);
  const edge = (from: number, to: number, axis: number) => vertices[3 * to + axis]! - vertices[3 * from + axis]!;
  for (let at = 0; at < triangles.length; at += 3) {
    const [i, j, k] = [triangles[at]!, triangles[at + 1]!, triangles[at + 2]!];
    for (let axis = 0; axis < 3; axis++) {
      const [next, last] = [(axis + 1) % 3, (axis + 2) % 3];
      normals[at + axis] = edge(i, j, next) * edge(i, k, last) - edge(i, j, last) * edge(i, k, next);
    }
  }
  return normals;
}
