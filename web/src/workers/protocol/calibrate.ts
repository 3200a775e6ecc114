import type { MeasuredDistortion } from '../../document/measuring';

export interface FoundGrid {
  readonly beads: Float64Array<ArrayBuffer>;
  readonly marks: number;
  readonly radius: number;
  readonly distortion: MeasuredDistortion | null;
  readonly refusal: string | null;
}

/** What the calibration worker can do. */
export interface CalibrateProtocol {
  find: {
    input: {
      readonly pixels: Uint8Array<ArrayBuffer> | Uint16Array<ArrayBuffer>;
      readonly width: number;
      readonly height: number;
      /** Px; 0 for any. */
      readonly radius: number;
      readonly bright: boolean;
    };
    output: FoundGrid;
    progress: never;
  };
}
