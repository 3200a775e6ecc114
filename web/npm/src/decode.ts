import init, { decode_model } from './pkg/decode/fluoropose_decode.js';
import { read } from './read.js';
import type { Mesh } from './types.js';

let ready: Promise<unknown> | undefined;

/** Triangles of an STL, OBJ or PLY file; throws a sentence for anything else. */
export async function decodeModel(bytes: Uint8Array): Promise<Mesh> {
  const address = new URL('./pkg/decode/fluoropose_decode_bg.wasm', import.meta.url);
  await (ready ??= init({ module_or_path: read(address) }));
  const model = decode_model(bytes, 'the model');
  try {
    return { vertices: model.vertices, triangles: model.triangles };
  } finally {
    model.free();
  }
}
