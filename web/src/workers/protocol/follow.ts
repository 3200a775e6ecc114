import type { Candidate } from '../../document/types';
import type { PoseNumbers, Uncertainty } from '../../geometry/pose_numbers';
import type { Directions } from '../../geometry/axes';
import type { ComponentName } from '../../terms/component';
import type { ModelMesh } from './decode';
import type { CameraInput } from './camera';
import type { FirstPosesProtocol } from './first_poses';
import type { FramePixels } from './frame_pixels';

/** Follows one component through a film: one worker a component. Frames are numbered from 0. */
export interface FollowProtocol extends FirstPosesProtocol {
  /** Begins to read profiles of the film around the first poses that are given; gives the first frame that is to be looked at. */
  readFilm: { input: FilmReading; output: number | null; progress: never };
  /** Reads them in the frame that was asked for: none where the component is not found there. */
  lookFilm: { input: FramePixels; output: FilmSeen; progress: never };
  /** Gives the first frame that is to be looked at; null where there is none. */
  begin: { input: FollowInput; output: number | null; progress: never };
  /** Looks at the frame that was asked for, or searches it as a whole: it can be called off then. */
  look: { input: FramePixels; output: Seen; progress: { readonly fraction: number } };
  /** Begins to look at frames from both sides of the mirror; gives the first one. */
  seeSides: { input: null; output: number | null; progress: never };
  /** Begins to choose the side of the mirror; gives the first frame that is to be looked at again. */
  sides: { input: { readonly femurs: Femurs | null }; output: number | null; progress: never };
  /**
   * Once all was done with what was known of the femur then: the first frame that is to be looked at where more is known of it now, and that
   * tells another side; null where all stands.
   */
  standsWith: { input: { readonly femurs: Femurs | null }; output: number | null; progress: never };
  /**
   * Once all is done, begins to look for the component where it is lost, or lies on other edges, beside the `other` one in the frames in which that is
   * good; gives the first frame that is to be searched.
   */
  lookBeside: {
    input: { readonly other: readonly (PoseNumbers | null)[]; readonly otherMiddles: Float64Array<ArrayBuffer>; readonly femurs: Femurs | null };
    output: number | null;
    progress: never;
  };
  /** The poses of the frames in which the component is good; of others none. */
  good: { input: { readonly otherMiddles: Float64Array<ArrayBuffer> }; output: readonly (PoseNumbers | null)[]; progress: never };
  /** Begins to read profiles of the film in frames in which the component is good, for `lookFilm`; gives the first of them, or null where these are too few. */
  askFilm: { input: FilmAsked; output: number | null; progress: never };
  /** Begins to look at frames from the other side of the mirror; gives the first one. */
  compare: { input: { readonly frames: readonly number[] }; output: number | null; progress: never };
  /** Ends the work before all is done. */
  stop: { input: null; output: null; progress: never };
  /** Distances from the camera, mm; NaN where the component is not to be trusted. */
  middles: { input: null; output: Float64Array<ArrayBuffer>; progress: never };
  conclude: { input: { readonly otherMiddles: Float64Array<ArrayBuffer> }; output: readonly FollowedFrame[]; progress: never };
}

interface FilmSubject {
  readonly mesh: ModelMesh;
  readonly camera: CameraInput;
  readonly frames: number;
  readonly component: ComponentName;
  /** Side of the squares that the film is read in, pixels. */
  readonly side: number;
}

export interface FilmReading extends FilmSubject {
  readonly given: FollowInput['given'];
  /** At the poses as they are, and in no frame beside them. */
  readonly justThere: boolean;
}

export interface FilmAsked extends FilmSubject {
  readonly otherMiddles: Float64Array<ArrayBuffer>;
}

export interface FilmSeen {
  readonly profiles: Float32Array<ArrayBuffer>;
  /** The frame that is to be looked at next; null where all is read. */
  readonly next: number | null;
}

export interface FollowInput {
  readonly mesh: ModelMesh;
  readonly camera: CameraInput;
  readonly frames: number;
  readonly first: number;
  readonly last: number;
  /** Poses to follow from: what a person set stays, and of others the film tells whether they are right. */
  readonly given: readonly { readonly frame: number; readonly pose: PoseNumbers; readonly isSet: boolean }[];
  /** Where it is lost it is looked for in whole frames, with what was opened for that. */
  readonly searches: boolean;
  /** What the film makes of the component; null where that is not known. */
  readonly film: readonly number[] | null;
}

export interface Seen {
  /** Where the component was found in the frame. */
  readonly pose: PoseNumbers | null;
  /** It was looked for there beside the other component. */
  readonly isBeside: boolean;
  /** The frame that is to be looked at next; null where this part of the work is done. */
  readonly next: number | null;
}

/** The femoral poses of all frames, and the axes of both models. */
export interface Femurs {
  readonly poses: readonly (PoseNumbers | null)[];
  readonly axes: Directions;
  readonly own: Directions;
}

export type FollowState = 'fixed' | 'followed' | 'interpolated' | 'doubtful' | 'untrackable' | 'unsolved';

export interface FollowedFrame {
  readonly state: FollowState;
  /** A sentence without its full stop. */
  readonly because: string;
  readonly pose: PoseNumbers | null;
  readonly deviations: Uncertainty | null;
  readonly residual: number | null;
  /** How bad it is: above 1 it is doubtful. */
  readonly badness: number;
  /** From the other side of the mirror, where that was compared and there is one. */
  readonly rival: Pick<Candidate, 'pose' | 'residual'> | null;
}
