/** Grey values of a frame, row by row. */
export interface FramePixels {
  readonly pixels: Uint8Array<ArrayBuffer> | Uint16Array<ArrayBuffer>;
  readonly width: number;
  readonly height: number;
}
