import type { GreyWindow } from '../../document/types';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import type { ComponentName } from '../../terms/component';
import type { Preprocessing } from '../../terms/seeing';
import type { CameraInput, DistortionInput } from './camera';
import type { DecodedFrame, ModelMesh } from './decode';

/** A film of frames with what was found in them, as it is written. */

/** A number over the film, NaN where there is none, with one standard deviation of each. */
export interface OverlayLine {
  readonly colour: string;
  /** Beside the curve's title; empty where there is one line alone. */
  readonly label: string;
  readonly values: Float64Array<ArrayBuffer>;
  readonly deviations: Float64Array<ArrayBuffer>;
}

export interface OverlayCurve {
  readonly title: string;
  readonly unit: string;
  readonly lines: readonly OverlayLine[];
}

/** What is the same in all its pictures. */
export interface OverlayLook {
  readonly name: string;
  /** Of the frames, px. */
  readonly width: number;
  readonly height: number;
  readonly frames: number;
  /** Pictures a second. */
  readonly rate: number;
  readonly curves: readonly OverlayCurve[];
  /** What stands where there are no curves. */
  readonly noCurves: string;
}

/** A model whose outline is laid on. */
export interface OverlayModel {
  readonly component: ComponentName;
  readonly colour: string;
  readonly mesh: ModelMesh;
}

/** One picture. */
export interface OverlayFrame {
  /** Of the film, from 0. */
  readonly index: number;
  /** As it was taken. */
  readonly frame: DecodedFrame;
  /** Null: the one that the frame suggests. */
  readonly window: GreyWindow | null;
  readonly preprocessing: Preprocessing;
  /** Where frames are shown undistorted. */
  readonly undistorted: DistortionInput | null;
  /** Null without a calibration: then there are no outlines. */
  readonly camera: CameraInput | null;
  readonly poses: readonly { readonly component: ComponentName; readonly pose: PoseNumbers }[];
  /** The frame's number in the film it comes from, its time where that is known, and what is to be said of it. */
  readonly heading: string;
  readonly time: string;
  readonly notes: readonly string[];
}

export type FilmType = 'mp4' | 'webm';

export interface OverlayProtocol {
  /** Which film this browser can write; null where none. */
  type: { input: OverlayLook; output: FilmType | null; progress: never };
  /** The models of all that follows. */
  models: { input: readonly OverlayModel[]; output: null; progress: never };
  /** `pictures`: a zip of PNGs instead of a film. What was begun before is let go. */
  begin: { input: { readonly look: OverlayLook; readonly form: FilmType | 'pictures' }; output: null; progress: never };
  add: { input: OverlayFrame; output: null; progress: never };
  finish: { input: null; output: Blob; progress: never };
  /** One picture alone, as PNG. */
  still: { input: { readonly look: OverlayLook; readonly frame: OverlayFrame }; output: Blob; progress: never };
}
