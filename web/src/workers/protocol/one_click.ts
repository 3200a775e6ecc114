import type { SignedDirections } from '../../geometry/axes';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import type { ComponentName } from '../../terms/component';
import type { FramePixels } from './frame_pixels';
import type { Match, Surroundings } from './match';
import type { CameraInput } from './camera';
import type { FilmMisfits } from './film';

/** The joint's other component in a frame, and the axes of both as the joint asks for them. */
export interface OtherInFrame {
  readonly pose: PoseNumbers;
  readonly axes: SignedDirections;
  readonly own: SignedDirections;
}

/** A first outline and pose from a click or a box. */
export interface OneClickInput {
  readonly component: ComponentName;
  readonly camera: CameraInput;
  readonly frame: FramePixels;
  /** Column and row of a click inside the implant, or left, top, right and bottom of a rough box. */
  readonly prompt: Float64Array<ArrayBuffer>;
  /** Metal is brighter than what surrounds it; null where the frame is to tell. */
  readonly bright: boolean | null;
  /** The outline of the other component, whose pixels are left out; columns and rows by turns. */
  readonly avoid: Float64Array<ArrayBuffer> | null;
  /** Without library and model only the region and its edges lead to an outline. */
  readonly withModel: boolean;
  /** The joint's other component: this one is looked for where its joint leaves it too. Null where it is not known. */
  readonly other: OtherInFrame | null;
  readonly around: Surroundings;
  /** What the film makes of the component; null where that is not known. */
  readonly film: readonly number[] | null;
  readonly misfits: FilmMisfits;
  /** A pose that was found there before: it is refined and judged, and nothing is looked for; null where there is none. */
  readonly pose: PoseNumbers | null;
}

export interface OneClickFacts {
  /** One for each candidate, the chosen first; columns and rows by turns. */
  readonly outlines: readonly Float64Array<ArrayBuffer>[];
  /** Parts of them that lie on edges of the right sign, 0 to 1; none without a model. */
  readonly supports: readonly number[];
  /** The poses are as the film puts the edges. */
  readonly corrected: boolean;
  /** The candidates' poses; null where no model led to the outline. */
  readonly match: Match | null;
  /** Metal was taken to be brighter than what surrounds it. */
  readonly bright: boolean;
  /** What was done and how sure it is. */
  readonly sentence: string;
}

export interface OneClickProtocol {
  oneClick: {
    input: OneClickInput;
    output: OneClickFacts;
    /** 0 to 1, and what is being done. */
    progress: { readonly fraction: number; readonly doing: string };
  };
}
