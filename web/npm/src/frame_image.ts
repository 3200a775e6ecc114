import { isEightBit } from './asked.js';
import { FrameImage } from './pkg/core/fluoropose_wasm.js';
import type { Grey, Size } from './types.js';

// Apart from what callers import: types that `wasm-bindgen` writes ask for a library of TypeScript that they may not have.

/** Calls `work` with a frame in WebAssembly's memory. */
export function withImage<T>(pixels: Grey, { width, height }: Size, work: (image: FrameImage) => T): T {
  const image = isEightBit(pixels) ? FrameImage.fromEightBit(pixels, width, height) : FrameImage.fromSixteenBit(pixels, width, height);
  try {
    return work(image);
  } finally {
    image.free();
  }
}
