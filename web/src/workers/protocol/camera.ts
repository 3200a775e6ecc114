/** A calibration text and the size of the frames that it is for. */
export interface CameraInput {
  readonly text: string;
  readonly width: number;
  readonly height: number;
  /** Outlines and overlays of frames that are shown as they were taken; absent where frames are undistorted. */
  readonly distortion?: DistortionInput;
}

/** A correction of distortion as the core takes it, and a text that tells it from others. */
export interface DistortionInput {
  readonly key: string;
  readonly numbers: Float64Array<ArrayBuffer>;
}

/** What a calibration says, for chips and forms. Millimetres; the camera in pixels. */
export interface CalibrationFacts {
  /** Null for a camera matrix. */
  readonly principal: {
    readonly distance: number;
    readonly offsetX: number;
    readonly offsetY: number;
    readonly pitch: number;
  } | null;
  /** Null while no frame tells the size. */
  readonly camera: { readonly fx: number; readonly fy: number; readonly cx: number; readonly cy: number } | null;
}
