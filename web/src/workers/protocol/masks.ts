/** What the worker of masks can do: images to outlines and back. */
export interface MasksProtocol {
  look: { input: { bytes: Uint8Array<ArrayBuffer>; name: string }; output: MaskLook; progress: never };
  /** Outlines of every label on every page; they arrive page by page. */
  read: {
    input: { bytes: Uint8Array<ArrayBuffer>; name: string; tolerance: number };
    output: readonly MaskPage[];
    progress: { readonly done: number; readonly total: number };
  };
  /** The outline of a mask, 1 inside, row by row; null where nothing is. */
  trace: { input: { inside: Uint8Array<ArrayBuffer>; width: number; height: number; tolerance: number }; output: MaskLabel | null; progress: never };
  /** One PNG for each outline, in a zip. */
  write: {
    input: { readonly masks: readonly MaskToWrite[] };
    output: Uint8Array<ArrayBuffer>;
    progress: { readonly done: number; readonly total: number };
  };
}

/**
 * How many labels the first page of a file has; one grey all over is none. More grey values than a mask has labels are graded where nearly all
 * pixels are decided, as a network's probabilities are, and null, no mask, elsewhere.
 */
export type MaskLook = number | 'graded' | null;

export interface MaskPage {
  readonly width: number;
  readonly height: number;
  readonly labels: readonly MaskLabel[];
}

export interface MaskLabel {
  /** Grey value. */
  readonly value: number;
  /** Few points near the border, columns and rows by turns. */
  readonly points: Float64Array<ArrayBuffer>;
  /** Along the cracks between pixels: filled again it gives the mask's pixels. */
  readonly exact: Float64Array<ArrayBuffer>;
  /** Pixels inside the outline, of specks that were left out, of holes that were filled. */
  readonly area: number;
  readonly specks: number;
  readonly holes: number;
  /** Pixels that the simplified outline has otherwise. */
  readonly differing: number;
}

export interface MaskToWrite {
  /** In the zip, with its folder. */
  readonly path: string;
  readonly width: number;
  readonly height: number;
  readonly points: Float64Array<ArrayBuffer>;
}
