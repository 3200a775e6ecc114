/** Column and row on the frame, pixels: columns grow to the right, rows down, the first pixel covers 0 to 1. */
export type Point = readonly [column: number, row: number];

/** Pixels. */
export interface Size {
  readonly width: number;
  readonly height: number;
}

/**
 * Where the model is: `X_camera = Rz * Rx * Ry * X_model + (x, y, z)`. Millimetres and degrees. The camera is at the
 * X-ray focus, x to the right, y up, looking along -z: whatever is in view has negative z.
 */
export interface Pose {
  readonly x: number;
  readonly y: number;
  readonly z: number;
  readonly zRot: number;
  readonly xRot: number;
  readonly yRot: number;
}

/** A surface of triangles. */
export interface Mesh {
  /** x, y, z of each vertex, millimetres. */
  readonly vertices: Float32Array;
  /** Three vertex numbers for each triangle, from 0. */
  readonly triangles: Uint32Array;
}

/**
 * Which views of the model are rendered. Without `nominal`, `x` and `y` those of all directions, so that nothing needs to
 * be known of how the implant stands; with any of them a window of finer steps round a nominal view. Rotations are those
 * out of the image plane, degrees.
 */
export interface Views {
  /** Rotation about x and about y of a window's nominal view; left out, 0 and 0. */
  readonly nominal?: readonly [x: number, y: number];
  /** From, to and step of a window about x; left out, -15, 15 and 1. */
  readonly x?: readonly [from: number, to: number, step: number];
  /** From, to and step of a window about y; left out, -20, 20 and 1. */
  readonly y?: readonly [from: number, to: number, step: number];
  /**
   * From the focus to the object, mm; left out, nine tenths of the calibration's principal distance, or 1000. It sets the
   * perspective of the views, never a pose.
   */
  readonly distance?: number;
}

/** Grey values of a whole frame, row by row, 8 or 16 bits. */
export type Grey = Uint8Array | Uint16Array;

/** What a film makes of an implant's metal, as somebody knows it: it is taken as it is. */
export interface Film {
  /** Of the display, one divided by grey values: 0 is linear, 1 / g shows g grey values for a factor of e. */
  readonly curvature: number;
  /** Standard deviation of everything that blurs, px, at most 12. */
  readonly blur: number;
  /** Attenuation of the metal for thin layers, per mm. */
  readonly attenuation: number;
}

/** What is known of a film before its frames are asked. */
export interface StatedFilm {
  readonly display?: 'linear' | 'between' | 'logarithmic';
  /** Px, at most 12. */
  readonly blur?: number;
}

export interface ImplantOptions {
  /** The CAD model of the very size: a file's bytes (STL, OBJ or PLY in mm), or its triangles. */
  readonly model: Uint8Array | ArrayBuffer | Mesh;
  /** The text of a calibration file: `JT_INTCALIB`, MayaCam 2.0, or a camera matrix as OpenCV, ROS or MATLAB write it. */
  readonly calibration: string;
  readonly frame: Size;
  /** A library made before (`Implant.library`): nothing needs to be rendered. It is refused when it is of another model. */
  readonly library?: Uint8Array | ArrayBuffer;
  /** Left out: all directions. A library has its views, and none can be asked for beside it. */
  readonly views?: Views;
  /** Told while the library is rendered. */
  readonly onProgress?: (done: number, total: number) => void;
  /** Ends the rendering; `openImplant` then rejects with the signal's reason. */
  readonly signal?: AbortSignal;
}

/** What the frames of a study tell of their film; from `estimateFilm`. */
export interface FilmConstants {
  /** As a person would say it: "nearly linear film, blur 1.3 px". */
  readonly words: string;
  /** Px. */
  readonly blur: number;
  /** Profiles across outlines that were believed. */
  readonly profiles: number;
  /** Of each implant that was seen, as `pose` takes it: curvature, blur and attenuation, their covariance, and what squares of pixels it was read in. */
  readonly models: ReadonlyMap<object, readonly number[]>;
}

/** The joint's other component in a frame: how both lie to each other is taken in the axes that their shapes tell, whatever those of the files. */
export interface Beside {
  /** An `Implant`. */
  readonly implant: Shaped;
  readonly pose: Pose;
}

/** Who knows its axes by its shape: an `Implant`. */
export interface Shaped {
  axes(component: 'femur' | 'tibia'): Float64Array;
}

/** What else is known of an outline and of what is round it. */
export interface Hints {
  /** Sides of the outline that are not to be trusted, from 0: side `i` runs from point `i` to the next. */
  readonly unknownSides?: readonly number[];
  /**
   * Who laid the outline on the frame; left out, a hand or a network. It lies off the implant's outline everywhere alike by a distance
   * that nobody knows, a tool's, on the frame's edges, more than a hand's, and depth is uncertain by millimetres: with `image` and
   * `film` it is not. An outline that was `drawn` from the model itself lies on it.
   */
  readonly laidBy?: 'hand' | 'drawn' | 'tool' | 'mixed';
  /** The femoral component in the same frame, for a tibial one; a pose alone is taken in the axes of both files, which have to be the field's. */
  readonly femur?: Beside | Pose;
  /** The tibial component in the same frame, for a femoral one; as `femur`, and never with it. */
  readonly tibia?: Beside | Pose;
  /** Poses of the same component in the frames before and after. */
  readonly neighbours?: readonly Pose[];
  /** The frame that was traced: poses are then brought onto its edges. */
  readonly image?: Grey;
  /** Metal is brighter in it than what surrounds it; the frame tells where this is left out. */
  readonly bright?: boolean;
  /** What the film makes of `image`, null where that is not known: depth is uncertain by millimetres then. */
  readonly film?: Film | FilmConstants | null;
}

/** One pose that explains an outline. */
export interface Candidate {
  readonly pose: Pose;
  /** One standard deviation of each number; null where the outline does not determine it, and for poses of the library. */
  readonly deviations: Pose | null;
  /** What remains between the outlines, px; null for a pose of the library. */
  readonly residual: number | null;
  /** Unmatched pixels in the canonical frame, where a silhouette has 938 of all directions and 15 000 of a window; null where a part of the outline led to the pose. */
  readonly unmatched: number | null;
  /** The best view lies at the border of a window: the truth may lie beyond it. */
  readonly atBorder: boolean;
}

/** How far a pose is to be trusted, and why: a sentence without its full stop. */
export interface Verdict {
  readonly word: 'good' | 'doubtful';
  readonly because: string;
}

export interface FoundPose {
  /** The pose of the first candidate. */
  readonly pose: Pose;
  /** The chosen one first, then its rivals. */
  readonly candidates: readonly Candidate[];
  /** Whether anything spoke for the first one besides a slightly smaller residual. */
  readonly decided: boolean;
  /** Why the first one was chosen, a sentence; null for poses of the library. */
  readonly reason: string | null;
  /** How far the first one is to be trusted; null for poses of the library. Where nothing fits there is no pose. */
  readonly verdict: Verdict | null;
  /** Only a part of the outline was known: pieces of it led to the poses. */
  readonly partial: boolean;
}
