import init from '../../pkg/core/fluoropose_wasm.js';
import address from '../../pkg/core/fluoropose_wasm_bg.wasm?url';

/** The whole core. */
export async function loadCore(): Promise<unknown> {
  return init({ module_or_path: address });
}
