import type { Directions } from '../../geometry/axes';
import type { PoseNumbers, Uncertainty } from '../../geometry/pose_numbers';
import type { ComponentName } from '../../terms/component';
import type { CameraInput } from './camera';
import type { ModelMesh } from './decode';
import type { FramePixels } from './frame_pixels';

/** One component of a joint. Without a model nothing is known of lowest points. */
export interface JointPart {
  readonly mesh: ModelMesh | null;
  readonly axes: Directions;
}

export interface JointModels {
  readonly femur: JointPart;
  readonly tibia: JointPart;
  readonly side: 'left' | 'right';
}

export interface JointFacts {
  /** Names of the numbers of a frame, in their order. */
  readonly columns: readonly string[];
  /** Lowest points and lift-off are known. */
  readonly hasPlate: boolean;
  /** The border of the tray's plate from above: anterior and medial place of each point, mm; empty where there is none. */
  readonly plate: Float64Array;
  /** What the femur's flange says of the side of the body, where it tells the other one: a sentence without its full stop. */
  readonly otherSide: string | null;
}

/** A pose, and how uncertain it is, where that is known. */
export interface Uncertain {
  readonly pose: PoseNumbers;
  readonly deviations: Uncertainty | null;
}

/** A frame of what is published: its numbers, as the open joint gave them. */
export interface PublishedFrame {
  readonly numbers: Float64Array<ArrayBuffer> | null;
  readonly checked: boolean;
  /** Why poses of it were doubtful that a person has accepted; null where none were. */
  readonly accepted: string | null;
  /** Why it is doubtful; null where it is not. */
  readonly doubt: string | null;
}

/** All that files, figure and report of the open joint tell. */
export interface PublishedFilm {
  readonly name: string;
  /** Frames a second; NaN where nobody said. */
  readonly rate: number;
  readonly frames: readonly PublishedFrame[];
  readonly inputs: readonly { readonly what: string; readonly name: string; readonly sha256: string }[];
  readonly settings: readonly (readonly [string, string])[];
  readonly remarks: readonly string[];
}

/** A text that is made of the numbers; `cycle`: one of them at 101 points. */
export type JointText = { readonly form: 'table' | 'mot' | 'figure' | 'report' } | { readonly form: 'cycle'; readonly column: string };

/** A text that is made of poses, a row a frame. */
export type PoseText =
  | { readonly form: 'jtak' | 'jtap'; readonly poses: readonly (PoseNumbers | null)[] }
  | { readonly form: 'tra'; readonly poses: Readonly<Record<ComponentName, readonly (PoseNumbers | null)[]>> };

export interface JointOfFrames {
  /** One frame after another: those that have names, and then what the core needs of them again. */
  readonly numbers: Float64Array<ArrayBuffer>;
  /** Why no knee has one of a frame's numbers, without its full stop; null where it can have them. */
  readonly impossible: readonly (string | null)[];
  /** The largest of a frame's translations, mm, where it is no knee's because a model's origin lies far off the component; null else. */
  readonly originsApart: readonly (number | null)[];
}

/** A pose, and one standard deviation of its depth, mm; null where that is not known. */
export interface LyingPose {
  readonly pose: PoseNumbers;
  readonly depth: number | null;
}

/** Where the components of a knee lie in each frame. */
export interface KneeFilm {
  /** Of models and axes. */
  readonly key: string;
  readonly femur: JointPart;
  readonly tibia: JointPart;
  readonly frames: readonly { readonly femur: LyingPose | null; readonly tibia: LyingPose | null }[];
}

/** Frames are numbered from 0. */
export interface FlippedLook {
  readonly component: ComponentName;
  readonly frame: number;
}

export interface LyingBeside {
  readonly sentence: string;
  /** Farther off than mirrored pictures leave a tray: there a pose that is good by itself is not doubtful for one that is not. */
  readonly isBeyondFlipping: boolean;
}

export interface JointProtocol {
  /** What the numbers of a joint are taken of, until another one is opened. */
  openJoint: { input: JointModels; output: JointFacts; progress: never };
  /** The numbers of frames, NaN for what is not known. Throws while no joint is open. */
  joint: { input: readonly { readonly femur: Uncertain; readonly tibia: Uncertain }[]; output: JointOfFrames; progress: never };
  /** The same text as the command line's. Throws while no joint is open, and for what needs times where there are none. */
  publish: { input: { readonly film: PublishedFilm; readonly what: JointText }; output: string; progress: never };
  /** The figure of four panels as PDF, the same as the command line's. Throws while no joint is open. */
  figurePdf: { input: PublishedFilm; output: Uint8Array<ArrayBuffer>; progress: never };
  /** What is told of each frame of a film whose components lie beside each other as in no knee, without its full stop; null where nothing is. */
  lyingBeside: { input: KneeFilm; output: readonly (LyingBeside | null)[]; progress: never };
  /** Begins to look at some of a film's frames as if they were flipped left to right; gives what is to be looked at first, null where nothing is. What was seen counts for `lyingBeside`. */
  beginFlipped: { input: KneeFilm; output: FlippedLook | null; progress: never };
  /** Looks at the frame that was asked for; gives the next. */
  lookFlipped: { input: FramePixels & { readonly camera: CameraInput; readonly film: readonly number[] | null }; output: FlippedLook | null; progress: never };
  poseText: { input: PoseText; output: string; progress: never };
}
