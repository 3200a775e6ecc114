import { simd } from 'wasm-feature-detect';
import init from '../../pkg/core/fluoropose_wasm.js';
import plainAddress from '../../pkg/core/fluoropose_wasm_bg.wasm?url';
import wideAddress from '../../pkg/core/fluoropose_wasm_simd_bg.wasm?url';

/** The whole core, in the form that this engine runs: with 128-bit vectors where it has them. */
export async function loadCore(): Promise<unknown> {
  return init({ module_or_path: (await simd()) ? wideAddress : plainAddress });
}
