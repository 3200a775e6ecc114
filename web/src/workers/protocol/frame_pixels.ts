/** Grey values of a frame, row by row. */
export interface FramePixels {
  readonly pixels: Uint8Array<ArrayBuffer> | Uint16Array<ArrayBuffer>;
  readonly width: number;
  readonly height: number;
  /** Pixels that are not of the picture, numbered row by row: of each run the first one, and the one after its last. */
  readonly covered: Uint32Array<ArrayBuffer>;
}
