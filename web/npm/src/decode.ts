import init, { decode_model } from './pkg/decode/fluoropose_decode.js';
import { read } from './read.js';
import type { Mesh } from './types.js';

let ready: Promise<unknown> | undefined;

export interface DecodedModel {
  readonly mesh: Mesh;
  /** What the file's reader has to say of it. */
  readonly notes: readonly string[];
}

/** Triangles of an STL, OBJ or PLY file; throws a sentence for anything else. */
export async function decodeModel(bytes: Uint8Array): Promise<DecodedModel> {
  const address = new URL('./pkg/decode/fluoropose_decode_bg.wasm', import.meta.url);
  await (ready ??= init({ module_or_path: read(address) }));
  const model = decode_model(bytes, 'the model');
  try {
    return { mesh: { vertices: model.vertices, triangles: model.triangles }, notes: model.notes };
  } finally {
    model.free();
  }
}
