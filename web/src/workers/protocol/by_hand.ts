import type { Verdict } from '../../document/types';
import type { PoseNumbers, Uncertainty } from '../../geometry/pose_numbers';
import type { ComponentName } from '../../terms/component';
import type { MatchInput, Surroundings } from './match';
import type { CameraInput } from './camera';
import type { FramePixels } from './frame_pixels';

/** What the pose worker does with a pose that somebody set, and with all views of a library. */

/** The frame itself is what a pose is held against; edges of the other components at their poses do not count. */
export interface OnFrame {
  readonly component: ComponentName;
  readonly camera: CameraInput;
  readonly frame: FramePixels;
  readonly others: readonly { readonly component: ComponentName; readonly pose: PoseNumbers }[];
  /** The outline of which sides are marked unknown, along which edges do not count either; null where none are. */
  readonly unknown: Pick<MatchInput, 'outline' | 'unknownSides'> | null;
  /** Metal is brighter than what surrounds it; null where that is not known. */
  readonly bright: boolean | null;
  /** What the film makes of the component; null where that is not known. */
  readonly film: readonly number[] | null;
}

/** What a pose that somebody set is held against. */
export interface AroundHand extends Surroundings {
  /** Poses that had been found there. */
  readonly rivals: readonly PoseNumbers[];
}

/** Where refinement starts, and which of the six numbers stay, in the order of `poseArray`. */
export interface HandStart {
  readonly start: PoseNumbers;
  readonly locked: readonly boolean[];
  readonly around: AroundHand;
}

/** A pose that is there. */
export interface HandSet {
  readonly pose: PoseNumbers;
  readonly around: AroundHand;
}

export interface FitFacts {
  readonly pose: PoseNumbers;
  /** Px. */
  readonly residual: number;
  /** Frame pixels that differ from the outline; null without one. */
  readonly drawn: number | null;
  /** Null where numbers were locked, or the pose is not determined. */
  readonly deviations: Uncertainty | null;
  /** The implant was taken to be brighter than what surrounds it; of the frame alone. */
  readonly bright: boolean;
  readonly verdict: Verdict;
}

/** Where the frame's edges lie along a model's outline, as `EdgeReadings` of the core has it. */
export interface EdgeFacts {
  /** `EDGE_NUMBERS` for each piece of the outline: column, row, the outward normal, its length (px), how far beyond it the edge lies (px, NaN where there is none), met (1 or 0, NaN where nothing can be told). */
  readonly numbers: Float32Array<ArrayBuffer>;
  /** Part of the outline that is met, of what can be told. */
  readonly met: number;
  /** Part of the outline of which anything can be told. */
  readonly known: number;
  /** Of what is met, px. */
  readonly residual: number;
}

export const EDGE_NUMBERS = 7;

/** A grid of views: the rotation of the first, degrees, the step, and how many. */
export interface GridAxis {
  readonly first: number;
  readonly step: number;
  readonly count: number;
}

/** Unmatched canonical pixels of every view for an outline. */
export interface LandscapeFacts {
  readonly x: GridAxis;
  readonly y: GridAxis;
  /** x rotations run fastest. */
  readonly scores: Uint32Array<ArrayBuffer>;
  /** Best first, between the views. */
  readonly minima: readonly Minimum[];
}

export interface Minimum {
  /** Degrees. */
  readonly x: number;
  readonly y: number;
  readonly unmatched: number;
}

export interface HandProtocol {
  /** From a start onto the outline. */
  refineFrom: { input: MatchInput & HandStart; output: FitFacts; progress: never };
  /** From a start onto the edges of the frame. */
  refineOnFrame: { input: HandStart & OnFrame; output: FitFacts; progress: never };
  /** How far a pose that somebody set is to be trusted, by the outline or by the frame. */
  judgeOutline: { input: MatchInput & HandSet; output: Verdict; progress: never };
  judgeOnFrame: { input: OnFrame & HandSet; output: Verdict; progress: never };
  /** What was seen along the outline at a pose. */
  readOnFrame: { input: OnFrame & { readonly pose: PoseNumbers }; output: EdgeFacts; progress: never };
  /** Throws for an outline of which only a part is known. */
  landscape: { input: MatchInput; output: LandscapeFacts; progress: never };
  viewPose: {
    input: MatchInput & { readonly view: number };
    output: { readonly pose: PoseNumbers; readonly unmatched: number };
    progress: never;
  };
}
