import { FrameImage } from '../../pkg/core/fluoropose_wasm.js';

/** Moves a frame's pixels into WASM memory. */
export function imageOf({ pixels, width, height }: { pixels: Uint8Array | Uint16Array; width: number; height: number }): FrameImage {
  return pixels instanceof Uint8Array ? FrameImage.fromEightBit(pixels, width, height) : FrameImage.fromSixteenBit(pixels, width, height);
}
