import type { ModelMesh } from '../workers/protocol/decode';

const HEAD = 80;
/** Normal and three corners, and two bytes that nobody uses. */
const TRIANGLE = 50;
const CORNERS = 12;

/** A mesh as a binary STL file, every length times `scale`. Normals are left to who reads it. */
export function stlOf({ vertices, triangles }: Pick<ModelMesh, 'vertices' | 'triangles'>, scale: number): Uint8Array<ArrayBuffer> {
  const count = triangles.length / 3;
  const bytes = new Uint8Array(HEAD + 4 + count * TRIANGLE);
  const view = new DataView(bytes.buffer);
  view.setUint32(HEAD, count, true);
  triangles.forEach((vertex, corner) => {
    const start = HEAD + 4 + Math.floor(corner / 3) * TRIANGLE + CORNERS * (1 + (corner % 3));
    for (let axis = 0; axis < 3; axis++) view.setFloat32(start + 4 * axis, scale * vertices[3 * vertex + axis]!, true);
  });
  return bytes;
}
