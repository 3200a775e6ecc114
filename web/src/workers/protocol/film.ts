import type { Judged, StatedFilm } from '../../document/types';
import type { PoseNumbers, Uncertainty } from '../../geometry/pose_numbers';
import type { ComponentName } from '../../terms/component';
import type { OnFrame } from './by_hand';

/** What the pose worker does with a frame whose film is estimated, or known. */
export interface OnFilmProtocol {
  /** Profiles across the model's outline, as the film worker takes them. */
  filmProfiles: { input: OnFrame & { readonly pose: PoseNumbers; readonly side: number }; output: Float32Array<ArrayBuffer>; progress: never };
  /** Poses that were found on the frame, as its film puts the edges, and others that explain it as well. */
  correct: {
    input: OnFrame & {
      readonly candidates: readonly Uncorrected[];
      /** Which of them is the cell's pose. */
      readonly chosen: number;
      /** Where the chosen one leaves more than is usual, others are looked for around it. */
      readonly misfits: FilmMisfits;
    };
    output: readonly Corrected[];
    progress: never;
  };
}

/** What remains at other poses on the same film, px: of the same component in other frames, and of other components. */
export interface FilmMisfits {
  readonly own: readonly number[];
  readonly others: readonly number[];
}

export interface Uncorrected {
  readonly pose: PoseNumbers;
  /** Part of the outline that lies on edges; null where that was not kept. */
  readonly support: number | null;
}

export interface Corrected {
  /** Which of the poses it was; null for another one. One that cannot be brought there is missing. */
  readonly from: number | null;
  readonly pose: PoseNumbers;
  readonly residual: number | null;
  readonly deviations: Uncertainty | null;
  readonly judged: Judged | null;
  /** Part of the outline that lies on edges. */
  readonly support: number;
  /** The model's silhouette there; columns and rows by turns. */
  readonly outline: Float64Array<ArrayBuffer>;
}

/** Profiles of a component in a frame; none take away those that were known. */
export interface ReadProfiles {
  readonly component: ComponentName;
  readonly frame: number;
  readonly profiles: Float32Array<ArrayBuffer>;
}

export interface FilmFacts {
  readonly words: string;
  readonly blur: number;
  readonly curved: number;
  readonly profiles: number;
  readonly models: Readonly<Record<ComponentName, readonly number[] | null>>;
}

/** The film worker keeps the profiles of all frames, read in squares of one size: others are kept anew; null where they do not tell. What is stated in whole is taken as it is. */
export interface FilmProtocol {
  estimate: {
    input: { readonly read: readonly ReadProfiles[]; readonly stated: StatedFilm; readonly side: number };
    /** Why the frames tell nothing, where their grey values are cut off: a sentence without its full stop. */
    output: FilmFacts | { readonly clipped: string } | null;
    progress: never;
  };
  /** Begins to find the squares of pixels that the film is read in. */
  beginSquares: { input: { readonly stated: StatedFilm }; output: SquaresState; progress: never };
  /** Takes what was read in those that are wanted. */
  takeSquares: { input: { readonly read: readonly ReadProfiles[]; readonly stated: StatedFilm }; output: SquaresState; progress: never };
  /** The constants by frames that were followed, where those that the film was followed with do not stand; null where they do. */
  learntAgain: {
    input: { readonly followed: readonly FollowedProfiles[]; readonly stated: StatedFilm };
    output: FilmFacts | null;
    progress: never;
  };
  /** Keeps profiles for the next estimate. */
  take: { input: { readonly read: readonly ReadProfiles[]; readonly side: number }; output: null; progress: never };
}

/** The squares to read profiles in next, null where they are found; and those that are well so far. Sides, pixels. */
export interface SquaresState {
  readonly wanted: number | null;
  readonly side: number;
  /** Somebody states the blur, or profiles told it. */
  readonly isTold: boolean;
}

/** What was read of a component that was followed with what was `known` of the film. */
export interface FollowedProfiles {
  readonly component: ComponentName;
  readonly known: readonly number[];
  readonly read: readonly ReadProfiles[];
}
