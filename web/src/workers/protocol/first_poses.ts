import type { Directions } from '../../geometry/axes';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import type { Told } from '../../document/types';
import type { ComponentName } from '../../terms/component';
import type { CameraInput } from './camera';
import type { ModelMesh } from './decode';
import type { FramePixels } from './frame_pixels';

/** Looks for a component that nobody pointed at. Frames are numbered from 0. */
export interface FirstPosesProtocol {
  /** In which order components are looked for; gives what is to be done first. One worker has the order of all. */
  plan: { input: PlanInput; output: PlanState; progress: never };
  /** Takes what came of a step; gives the next. */
  planned: { input: StepAnswer; output: PlanState; progress: never };
  /** Distances in mm of the libraries that a component is looked for with, in the order in which they are tried. */
  distances: { input: DistancesInput; output: readonly number[]; progress: never };
  /** What frames are searched with, until the next one. */
  openSearch: { input: SearchInput; output: null; progress: never };
  /** Another library for that, as of another distance. They are numbered as they were given, from 0. */
  addLibrary: { input: { readonly library: Uint8Array<ArrayBuffer> }; output: null; progress: never };
  /** Whether metal is bright in a frame in which the component is known. */
  isBright: { input: FramePixels & { readonly pose: PoseNumbers }; output: boolean; progress: never };
  /** Looks for the component in a frame; null where it is nowhere. */
  find: { input: FramePixels & FindInput; output: Discovery | null; progress: { readonly fraction: number } };
  /** Begins to follow it from a frame in which it is known to some before and after it, or up to another one; gives the first frame that is to be looked at. */
  beginWalk: { input: WalkInput; output: number | null; progress: never };
  /** Looks at the frame that was asked for. */
  walk: { input: FramePixels; output: { readonly next: number | null; readonly ends: Float64Array<ArrayBuffer> }; progress: never };
  /** Whether metal is bright in a frame, by a place in it (column and row). */
  isBrightNear: { input: FramePixels & { readonly place: readonly [number, number] }; output: boolean; progress: never };
  /** How a pose that a click led to lies in its frame. */
  clickStands: { input: FramePixels & Pick<Clicked, 'pose'> & { readonly bright: boolean }; output: { readonly score: number; readonly convinces: boolean }; progress: never };
  /** Compares a click with what the last walk led to in its frame. */
  clickOutcome: { input: FramePixels & Clicked; output: ClickOutcome; progress: never };
}

export interface WalkInput {
  readonly frame: number;
  readonly pose: PoseNumbers;
  readonly frames: number;
  readonly bright: boolean;
  /** Null: some frames to both sides. */
  readonly goal: number | null;
}

/** A click: the pose that it led to in a frame, and the column and row that were pointed at. */
export interface Clicked {
  readonly frame: number;
  readonly pose: PoseNumbers;
  readonly place: readonly [number, number];
}

/** The click leads, or what the film finds without it: the same, or another. */
export type ClickOutcome = 'leads' | 'same' | 'outdone';

/** A component of the joint: its model, and its axes as they are known. */
export interface Member {
  readonly component: ComponentName;
  readonly mesh: ModelMesh;
  /** Null: its shape is to be asked. */
  readonly axes: { readonly directions: Directions; readonly told: Told } | null;
}

export interface PlanInput {
  readonly frames: number;
  /** It is known how the film shows metal. */
  readonly told: boolean;
  readonly parts: readonly (Member & { readonly known: readonly Known[] })[];
}

export interface Known {
  readonly frame: number;
  readonly pose: PoseNumbers;
}

export interface PlanState {
  /** Null where nothing is left to do. */
  readonly step: PlanStep | null;
  /** Where each component is known first: of dark metal and of bright, or of the one that was told. */
  readonly known: readonly (readonly (Known | null)[])[];
  /** Which of them counts, once nothing is left to do. */
  readonly way: number | null;
}

export interface PlanStep {
  /** 0 dark, 1 bright; where that was told always 0. */
  readonly way: number;
  /** Number of the component. */
  readonly part: number;
  readonly frame: number;
  /** In the whole frame; where its joint leaves it beside the other one; in the whole frame beside that; or it is to be followed from there. */
  readonly search: 'whole' | 'joint' | 'beside' | 'follow';
  /** Where a whole frame is searched. */
  readonly places: Places;
  /** About how far away the component is, mm, where another one tells that. */
  readonly depth: number | null;
  /** The pose that is known there: of the other component, or of the one that is to be followed. */
  readonly known: PoseNumbers | null;
}

/** Where something has a shape that the component has from some side, where something is dark, or the ones and then the others. */
export type Places = 'shaped' | 'dark' | 'all';

/** What came of a step: of a search, or of following. */
export type StepAnswer = { readonly found: Discovery | null } | { readonly ends: Float64Array<ArrayBuffer> };

export interface DistancesInput {
  readonly camera: CameraInput;
  /** Mm, where a person or the study says it. */
  readonly told: number | null;
  /** About how far away the component is, mm, where that is known. */
  readonly depth: number | null;
}

export interface SearchInput extends Member {
  readonly other: Member | null;
  readonly camera: CameraInput;
  readonly library: Uint8Array<ArrayBuffer>;
  /** Metal is brighter than what surrounds it. */
  readonly bright: boolean;
}

export interface FindInput {
  /** Number of the library that the frame is compared with. */
  readonly library: number;
  readonly bright: boolean;
  /** The pose of the joint's other component, and whether the joint tells where this one is. */
  readonly beside: { readonly pose: PoseNumbers; readonly inJoint: boolean } | null;
  /** Where a whole frame is searched. */
  readonly places: Places;
}

export interface Discovery {
  /** Column and row of a place in it. */
  readonly place: readonly [number, number];
  readonly pose: PoseNumbers;
  readonly score: number;
}
