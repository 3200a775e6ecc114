import type { HandProtocol } from './hand_protocol';
import type { OneClickProtocol } from './one_click_protocol';
import type { Candidate, ComponentName, LibrarySpec, PoseNumbers } from '../document/types';

/** What the workers can do; the page knows no more of WASM than this and `engine/film.ts`. */

/** A calibration text and the size of the frames that it is for. */
export interface CameraInput {
  readonly text: string;
  readonly width: number;
  readonly height: number;
  /** Outlines and overlays of frames that are shown as they were taken; absent where frames are straight. */
  readonly bend?: Bend;
}

/** A correction of distortion as the core takes it, and a text that tells it from others. */
export interface Bend {
  readonly key: string;
  readonly numbers: Float64Array<ArrayBuffer>;
}

/** What a calibration says, for chips and forms. Millimetres; the camera in pixels. */
export interface CalibrationFacts {
  /** Null for a camera matrix. */
  readonly principal: {
    readonly distance: number;
    readonly offsetX: number;
    readonly offsetY: number;
    readonly pitch: number;
  } | null;
  /** Null while no frame tells the size. */
  readonly camera: { readonly fx: number; readonly fy: number; readonly cx: number; readonly cy: number } | null;
}

export interface ModelMesh {
  /** x, y, z of each vertex, millimetres. */
  readonly vertices: Float32Array<ArrayBuffer>;
  /** Three vertices each. */
  readonly triangles: Uint32Array<ArrayBuffer>;
  /** What was left out of the file, a sentence each. */
  readonly notes?: readonly string[];
}

export interface DecodedFrame {
  readonly width: number;
  readonly height: number;
  readonly pixels: Uint8Array<ArrayBuffer> | Uint16Array<ArrayBuffer>;
  /** As the file suggests, if it does. */
  readonly window: { readonly centre: number; readonly width: number } | null;
  /** What was done to the pixels on the way, a sentence each. */
  readonly notes: readonly string[];
  /** What the file says of sizes and distances. */
  readonly geometry: StatedGeometry;
}

/** Lengths in mm as a file states them; null where it does not. Pairs: along a row, then from row to row. */
export interface StatedGeometry {
  readonly detectorSpacing: readonly [number, number] | null;
  readonly pixelSpacing: readonly [number, number] | null;
  readonly pixelSpacingCalibration: 'geometry' | 'fiducial' | null;
  readonly scannedSpacing: readonly [number, number] | null;
  readonly sourceToDetector: number | null;
  readonly sourceToPatient: number | null;
  readonly sourceToIsocentre: number | null;
  readonly magnification: number | null;
}

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

export interface LibraryFacts {
  readonly views: number;
  readonly bytes: number;
}

export type FileKind = 'frames' | 'model' | 'calibration' | 'poses' | 'library' | 'session' | 'outlines' | 'coco' | 'distortion' | 'video' | 'unknown';

export interface DecodeProtocol {
  /** By the file's beginning and its length, bytes. */
  sniff: { input: { head: Uint8Array<ArrayBuffer>; length: number; name: string }; output: FileKind; progress: never };
  /** Frames arrive one by one as progress. */
  frames: {
    input: { bytes: Uint8Array<ArrayBuffer>; name: string };
    output: number;
    progress: { readonly index: number; readonly total: number; readonly frame: DecodedFrame };
  };
  model: { input: { bytes: Uint8Array<ArrayBuffer>; name: string }; output: ModelMesh; progress: never };
}

/** What a library is built from. */
export interface LibraryPlan {
  readonly mesh: ModelMesh;
  readonly camera: CameraInput;
  readonly spec: LibrarySpec;
}

export interface LibraryProtocol {
  /** Forgets the plan before; gives the number of views. */
  plan: { input: LibraryPlan; output: number; progress: never };
  /** Some views, drawn and packed. */
  pack: { input: { first: number; count: number }; output: Uint8Array<ArrayBuffer>; progress: never };
  /** The library of all views, packed by workers of the same plan, in their order. */
  assemble: { input: { parts: readonly Uint8Array<ArrayBuffer>[] }; output: Uint8Array<ArrayBuffer>; progress: never };
}

export interface MatchInput {
  readonly component: ComponentName;
  /** Columns and rows of the outline's points, by turns. */
  readonly outline: Float64Array<ArrayBuffer>;
  /** Numbers of the sides that are marked unknown. */
  readonly unknownSides: Uint32Array<ArrayBuffer>;
  readonly camera: CameraInput;
}

/** A refined pose and what it leaves, px. */
export interface Refined {
  readonly pose: PoseNumbers;
  readonly residual: number;
}

/** Poses that a choice may rest on. */
export interface Surroundings {
  /** The other component in the same frame. */
  readonly counterpart: PoseNumbers | null;
  /** The same component in the frames before and after. */
  readonly neighbours: readonly PoseNumbers[];
}

export interface Choice {
  readonly index: number;
  readonly decided: boolean;
  readonly reason: string;
}

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

export interface PoseProtocol extends HandProtocol, OneClickProtocol {
  /** With its model, the library's poses are checked by drawing it; throws when it was made from another one. */
  open: {
    input: { component: ComponentName; bytes: Uint8Array<ArrayBuffer>; mesh: ModelMesh | null };
    output: LibraryFacts;
    progress: never;
  };
  /** `before` are poses that were refined for what the outline was a moment ago: where they still fit, they are followed. */
  match: { input: MatchInput & { readonly before: readonly Refined[] }; output: Match; progress: never };
  /** The same, then the model's outline brought onto the traced one. Without a model the answer is that of `match`. */
  refine: { input: MatchInput & { readonly around: Surroundings }; output: Match; progress: never };
  /** Chooses anew among refined poses when more is known round them; null where there are none. */
  choose: {
    input: {
      component: ComponentName;
      candidates: readonly Refined[];
      around: Surroundings;
    };
    output: Choice | null;
    progress: never;
  };
  /** The way of refinement from a start. */
  converge: { input: MatchInput & { readonly start: PoseNumbers }; output: readonly ConvergenceStep[]; progress: never };
}
