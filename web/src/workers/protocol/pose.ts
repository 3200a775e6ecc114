import type { Directions } from '../../geometry/axes';
import type { Axes } from '../../document/types';
import type { Vector } from '../../geometry/pose_motion';
import type { PoseNumbers, Uncertainty } from '../../geometry/pose_numbers';
import type { ComponentName } from '../../terms/component';
import type { CameraInput } from './camera';
import type { HandProtocol } from './by_hand';
import type { JointProtocol } from './joint';
import type { OnFilmProtocol } from './film';
import type { ModelMesh, ShapeFacts, StatedGeometry } from './decode';
import type { LibraryFacts } from './library';
import type { Choice, Match, MatchInput, Refined, Surroundings } from './match';
import type { OneClickProtocol } from './one_click';

/** A pose on the way of refinement. */
export interface ConvergenceStep {
  readonly stage: number;
  /** Times the model was drawn so far. */
  readonly renders: number;
  /** Square px; each stage has its own scale. */
  readonly loss: number;
  /** Px. */
  readonly residual: number;
  readonly pose: PoseNumbers;
}

export interface PoseProtocol extends HandProtocol, JointProtocol, OnFilmProtocol, OneClickProtocol {
  /** With its model, the library's poses are checked by drawing it; throws when it was made from another one. */
  open: {
    input: { component: ComponentName; bytes: Uint8Array<ArrayBuffer>; mesh: ModelMesh | null };
    output: LibraryFacts;
    progress: never;
  };
  /** Throws the core's sentence for a library that is damaged, before it takes the place of a sound one. */
  check: { input: { library: Uint8Array<ArrayBuffer> }; output: null; progress: never };
  /** A copy of an open library's bytes. */
  library: { input: { component: ComponentName }; output: Uint8Array<ArrayBuffer>; progress: never };
  /** What a model's surface and shape tell. */
  shape: { input: { mesh: ModelMesh }; output: ShapeFacts; progress: never };
  /** A calibration of any kind in a form that the page reads; throws the core's sentence about it. */
  calibrationText: { input: { text: string }; output: string; progress: never };
  /** What is told of each pose of a film that does not go through it, without its full stop; null where nothing is, or there is no good pose. */
  offTheWay: { input: { readonly poses: readonly (PoseNumbers | null)[] }; output: readonly (string | null)[]; progress: never };
  /** What is unusual of the camera of a calibration: sentences without their full stops. */
  cameraDoubts: { input: Pick<CameraInput, 'text' | 'width' | 'height'> & { readonly stated: StatedGeometry | null }; output: readonly string[]; progress: never };
  /** What a model's shape tells of its axes. */
  axes: { input: { component: ComponentName; mesh: ModelMesh }; output: Pick<Axes, 'directions' | 'told'>; progress: never };
  /** Which knee a femoral component is made for; null where its flange does not tell. */
  flangeSide: { input: { mesh: ModelMesh; axes: Directions }; output: 'left' | 'right' | null; progress: never };
  /** `before` are poses that were refined for what the outline was a moment ago: where they still fit, they are followed. */
  match: { input: MatchInput & { readonly before: readonly Refined[] }; output: Match; progress: never };
  /** The same, then the model's outline brought onto the traced one. Without a model the answer is that of `match`. */
  refine: { input: MatchInput & { readonly around: Surroundings }; output: Match; progress: never };
  /** Chooses anew among refined poses when more is known around them; null where there are none. */
  choose: {
    input: {
      component: ComponentName;
      candidates: readonly (Refined & { readonly deviations: Uncertainty | null })[];
      /** Of the component's model, in its file's axes, mm; null where that is not there. */
      middle: Vector | null;
      around: Surroundings;
    };
    output: Choice | null;
    progress: never;
  };
  /** The way of refinement from a start. */
  converge: { input: MatchInput & { readonly start: PoseNumbers }; output: readonly ConvergenceStep[]; progress: never };
}
