import type { Candidate, Verdict } from '../../document/types';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import type { Directions } from '../../geometry/axes';
import type { ComponentName } from '../../terms/component';
import type { CameraInput } from './camera';

/** What the matcher found for an outline, the chosen pose first. */
export interface Match {
  readonly candidates: readonly MatchedCandidate[];
  readonly canonicalSize: number;
  readonly canonicalArea: number;
  /** The canonical silhouette reaches its frame's border. */
  readonly clipped: boolean;
  /** Only a part of the outline is known: pieces of it led to the poses. */
  readonly partial: boolean;
  /** Why the first candidate was chosen; null for poses of the library. */
  readonly reason: string | null;
  readonly decided: boolean;
  /** On the first candidate; null for poses of the library, and where nothing fits. */
  readonly verdict: Verdict | null;
  /** Why no pose explains the outline; null where one does. */
  readonly refusal: string | null;
  readonly milliseconds: number;
}

/** A candidate with what the document does not keep of it. */
export interface MatchedCandidate extends Candidate {
  /** The pose that it was refined from; null where it is the library's. */
  readonly start: PoseNumbers | null;
  /** The view lies at the border of the library: the truth may lie beyond it. */
  readonly atBorder: boolean;
  /** Null where pieces of the outline led to the pose. */
  readonly picture: Picture | null;
}

/** Bits of the input's and the library view's canonical silhouettes, in the core's row order. */
export interface Picture {
  readonly size: number;
  readonly input: Uint8Array<ArrayBuffer>;
  readonly view: Uint8Array<ArrayBuffer>;
}

export interface MatchInput {
  readonly component: ComponentName;
  /** Columns and rows of the outline's points, by turns. */
  readonly outline: Float64Array<ArrayBuffer>;
  /** Numbers of the sides that are marked unknown. */
  readonly unknownSides: Uint32Array<ArrayBuffer>;
  /** Null: by a hand. */
  readonly laidBy: 'tool' | 'mixed' | null;
  readonly camera: CameraInput;
}

/** A refined pose and what it leaves, px; of poses that are compared, the misfit. */
export interface Refined {
  readonly pose: PoseNumbers;
  readonly residual: number;
}

/** The other component, with the anatomical axes of its model and those of the one that is chosen for. */
export interface Counterpart {
  readonly pose: PoseNumbers;
  readonly axes: Directions;
  readonly own: Directions;
}

/** Poses that a choice may rest on. */
export interface Surroundings {
  /** The other component in the same frame; null where the axes of either are not known, in which tilts are taken. */
  readonly counterpart: Counterpart | null;
  /** The same component in the frames before and after. */
  readonly neighbours: readonly PoseNumbers[];
}

export interface Choice {
  readonly index: number;
  readonly decided: boolean;
  readonly reason: string;
  /** Another pose fits as well: a sentence without its full stop; null where the others were ruled out. */
  readonly doubt: string | null;
}
