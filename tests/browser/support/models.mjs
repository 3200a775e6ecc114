/** Models as STL files, made from others or from nothing. */

/** @typedef {[number, number, number]} Corner mm */

/** Corners of the triangles of a binary STL. @param {Buffer} stl @returns {Corner[][]} */
export function trianglesOf(stl) {
  const count = stl.readUInt32LE(80);
  return Array.from({ length: count }, (_, triangle) =>
    [0, 1, 2].map((corner) => {
      const at = 84 + 50 * triangle + 12 + 12 * corner;
      return /** @type {Corner} */ ([0, 4, 8].map((offset) => stl.readFloatLE(at + offset)));
    }),
  );
}

/** @param {number[][][]} triangles */
export function stlOf(triangles) {
  const stl = Buffer.alloc(84 + 50 * triangles.length);
  stl.writeUInt32LE(triangles.length, 80);
  triangles.forEach((corners, triangle) =>
    corners.forEach((corner, index) => corner.forEach((value, axis) => stl.writeFloatLE(value, 84 + 50 * triangle + 12 + 12 * index + 4 * axis))),
  );
  return stl;
}

/** A tray without a notch: a plate 50 x 4 x 76 mm (x forwards or backwards, y up, z across) on a keel. */
export function plate() {
  return stlOf([...box([-25, 0, -38], [25, 4, 38]), ...box([-7, -40, -5], [7, 0, 5])]);
}

/** @param {Corner} low @param {Corner} high */
function box(low, high) {
  const corner = (/** @type {number} */ at) => low.map((value, axis) => ((at >> axis) & 1 ? high[axis] : value));
  const sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
  return sides.flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]]).map((triangle) => triangle.map(corner));
}
