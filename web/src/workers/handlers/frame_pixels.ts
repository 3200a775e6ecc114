import { FrameImage } from '../../pkg/core/fluoropose_wasm.js';
import type { FramePixels } from '../protocol/frame_pixels';

/** Moves a frame's pixels into WASM memory. */
export function imageOf({ pixels, width, height, covered }: { pixels: Uint8Array | Uint16Array; width: number; height: number; covered?: Uint32Array }): FrameImage {
  const image = pixels instanceof Uint8Array ? FrameImage.fromEightBit(pixels, width, height) : FrameImage.fromSixteenBit(pixels, width, height);
  if (covered) image.cover(covered);
  return image;
}

/** Calls `work` with a frame whose pixels are in WASM memory meanwhile. */
export async function withImage<T>(pixels: FramePixels, work: (image: FrameImage) => Promise<T>): Promise<T> {
  const image = imageOf(pixels);
  try {
    return await work(image);
  } finally {
    image.free();
  }
}
