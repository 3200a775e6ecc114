import type { Vector } from './pose_motion';

interface Mesh {
  /** x, y, z of each vertex, mm. */
  readonly vertices: Float32Array;
}

const middles = new WeakMap<Mesh, Vector>();

/** The middle of the model's bounding box, as the core has it. */
export function middleOf(mesh: Mesh): Vector {
  const known = middles.get(mesh);
  if (known) return known;
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  mesh.vertices.forEach((value, index) => {
    const axis = index % 3;
    if (value < (low[axis] ?? 0)) low[axis] = value;
    if (value > (high[axis] ?? 0)) high[axis] = value;
  });
  const middle = [0, 1, 2].map((axis) => ((low[axis] ?? 0) + (high[axis] ?? 0)) / 2) as unknown as Vector;
  middles.set(mesh, middle);
  return middle;
}
