import type { Judged, StatedFilm } from '../../document/types';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import type { ComponentName } from '../../terms/component';
import type { OnFrame } from './by_hand';

/** What the pose worker does with a frame whose film is estimated, or known. */
export interface OnFilmProtocol {
  /** Profiles across the model's outline, as the film worker takes them. */
  filmProfiles: { input: OnFrame & { readonly pose: PoseNumbers }; output: Float32Array<ArrayBuffer>; progress: never };
  /** Poses that were found on the frame, as its film puts the edges; null for one that cannot be brought there. */
  correct: {
    input: OnFrame & { readonly candidates: readonly Uncorrected[] };
    output: readonly (Corrected | null)[];
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
  /** Of the chosen pose: where it leaves more than is usual, a better one is looked for around it. Null of the others. */
  readonly misfits: FilmMisfits | null;
}

export interface Corrected {
  readonly pose: PoseNumbers;
  readonly residual: number | null;
  readonly deviations: PoseNumbers | null;
  readonly judged: Judged | null;
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

/** The film worker keeps the profiles of all frames; null where they do not tell. */
export interface FilmProtocol {
  estimate: {
    input: { readonly read: readonly ReadProfiles[]; readonly stated: StatedFilm };
    output: FilmFacts | null;
    progress: never;
  };
}
