import { Film } from '../../pkg/core/fluoropose_wasm.js';

/** Moves a frame's pixels into WASM memory. */
export function filmOf({ pixels, width, height }: { pixels: Uint8Array | Uint16Array; width: number; height: number }): Film {
  return pixels instanceof Uint8Array ? Film.fromEightBit(pixels, width, height) : Film.fromSixteenBit(pixels, width, height);
}
