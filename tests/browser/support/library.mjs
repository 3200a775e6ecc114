/** Library files, made by the page's own module in Node: a page opens libraries but does not save them. */
import { readFile } from 'node:fs/promises';
import { demoFile } from './study.mjs';

const MODULE = new URL('../../../web/src/pkg/core/', import.meta.url);
const FRAME = { width: 1024, height: 1024 };
/** Bytes of a binary STL before its first triangle, and of each triangle. */
const STL = { head: 84, triangle: 50 };

/**
 * A library of the demonstration's femur.
 *
 * @param {{ step: number }} views degrees between two views
 * @returns {Promise<Uint8Array>}
 */
export async function femurLibrary({ step }) {
  const core = await import(new URL('fluoropose_wasm.js', MODULE).href);
  core.initSync({ module: await readFile(new URL('fluoropose_wasm_bg.wasm', MODULE)) });
  const { vertices, triangles } = readStl((await demoFile('femur.stl')).buffer);
  const calibration = (await demoFile('calibration.txt')).buffer.toString();
  const views = new core.LibraryViews(
    Float64Array.of(0, 0),
    Float64Array.of(-15, 15, step),
    Float64Array.of(-20, 20, step),
    undefined,
    15_000,
  );
  const builder = new core.LibraryBuilder(vertices, triangles, calibration, FRAME.width, FRAME.height, views);
  builder.add(builder.pack(0, builder.views));
  return builder.finish();
}

/** Corners that are not shared: a library does not care. @param {Buffer} stl binary */
function readStl(stl) {
  const count = stl.readUInt32LE(STL.head - 4);
  const vertices = new Float32Array(9 * count);
  for (let corner = 0; corner < 9 * count; corner++) {
    const triangle = STL.head + STL.triangle * Math.floor(corner / 9);
    // After the normal.
    vertices[corner] = stl.readFloatLE(triangle + 12 + 4 * (corner % 9));
  }
  return { vertices, triangles: Uint32Array.from({ length: 3 * count }, (_, index) => index) };
}
