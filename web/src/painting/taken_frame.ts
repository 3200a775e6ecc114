import { FrameImage } from '../pkg/page/fluoropose_page.js';
import type { FramePixels } from '../workers/protocol/frame_pixels';

/** Moves a frame's pixels into the memory of the page's module. */
export function takenFrame({ pixels, width, height, covered }: FramePixels): FrameImage {
  const image = pixels instanceof Uint8Array ? FrameImage.fromEightBit(pixels, width, height) : FrameImage.fromSixteenBit(pixels, width, height);
  image.cover(covered);
  return image;
}
