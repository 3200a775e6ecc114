import type { Directions } from '../geometry/axes';
import type { FramePoint } from '../geometry/points';
import type { PoseNumbers, Uncertainty } from '../geometry/pose_numbers';
import type { ComponentName } from '../terms/component';
import type { LengthUnit } from '../terms/length_unit';
import { texts } from '../texts/texts';
import { Cells } from './cells';
import type { Distortion } from './distortion';

/**
 * The document: everything a person made or opened, as one immutable value. Bytes (files, pixels, libraries) live in
 * the asset store and in WASM memory; the document names them by their SHA-256.
 */
export interface Doc {
  readonly name: string;
  readonly side: Side;
  readonly frames: readonly FrameEntry[];
  /** Names of files of frames that were opened and could not be read: files of poses may have rows for them. */
  readonly unread: readonly string[];
  readonly calibration: Calibration | null;
  readonly components: Readonly<Record<ComponentName, Component>>;
  /** One cell a frame and component. */
  readonly cells: Cells<Cell>;
  /** Null until a frame is opened: its own suggestion is used. */
  readonly window: GreyWindow | null;
  /** Poses to compare with: those of a file, or what was shown when somebody kept them. */
  readonly reference: Reference | null;
  /** What people noted about cells, by `cellKey`. */
  readonly marks: Readonly<Record<string, Mark>>;
  /** How frames or outlines are undistorted; null: they stay as they were taken. */
  readonly distortion: Distortion | null;
  /** Frames a second; null while nobody has said. */
  readonly rate: number | null;
  /** What is known of how the frames show metal. */
  readonly film: Film;
  /** What the joint told last of the film as a whole, as that it is mirrored. */
  readonly kneeDoubt: KneeDoubt | null;
  /** Names this work in the browser's storage; empty until there is something to keep. No part of a session file. */
  readonly work: string;
}

export interface KneeDoubt {
  /** Of which models and axes. */
  readonly models: string;
  /** Without its full stop. */
  readonly sentence: string;
}

/** What a person says of a cell. */
export interface Mark {
  /** Fingerprint of what was looked at when the cell was marked checked; null: not checked. */
  readonly checked: string | null;
  readonly flagged: boolean;
  readonly note: string;
}

export interface Reference {
  /** Where they come from, for people. */
  readonly name: string;
  /** By `cellKey`. */
  readonly poses: Readonly<Record<string, PoseNumbers>>;
}

export type Side = 'left' | 'right' | 'unknown';

/** One image; a file may hold many. */
export interface FrameEntry {
  /** Stable for the life of the document: `sha256:index`. */
  readonly id: string;
  readonly name: string;
  /** SHA-256 of the file that holds it. */
  readonly source: string;
  readonly indexInSource: number;
  readonly width: number;
  readonly height: number;
}

/** Text in one of the two formats that the core reads; typed values are written as such a text first. */
export interface Calibration {
  readonly name: string;
  readonly text: string;
}

export interface Component {
  readonly model: ModelReference | null;
  readonly libraryFile: FileReference | null;
  readonly librarySpec: LibrarySpec;
  /** Null until its shape has been looked at, or somebody said. */
  readonly axes: Axes | null;
}

/** Which way a component lies in the coordinates of its file, and who said so. */
export interface Axes {
  readonly directions: Directions;
  readonly from: 'shape' | 'person' | 'study';
  readonly told: Told;
}

/**
 * What of them is known. `not the front`: anterior and right may both have the other sign. `no signs`: each of the three
 * may; of a femur right alone is known. `nothing`: they are the file's own, and nobody said that these are right.
 */
export type Told = 'all' | 'not the front' | 'no signs' | 'nothing';

export interface FileReference {
  readonly name: string;
  /** SHA-256 of the bytes, hexadecimal. */
  readonly sha256: string;
}

/** A model, and the file that it was written again from, in millimetres. */
export interface ModelReference extends FileReference {
  readonly writtenFrom?: WrittenFrom;
}

export interface WrittenFrom {
  readonly name: string;
  readonly unit: LengthUnit;
  /** Of that file, by which it is known when it comes again; sessions from before have none. */
  readonly sha256?: string;
}

/** Which views a library holds. */
export type LibrarySpec = AllDirections | ViewWindow;

/** Nothing needs to be known of how the implant stands. */
export interface AllDirections {
  readonly views: 'all directions';
  /** From the focus to the implant, mm; null: by the calibration. It sets the perspective of the views, never a pose. */
  readonly distance: number | null;
}

/** Degrees around a nominal view, canonical pixels; finer than all directions, as Walker et al. 1996 have it. */
export interface ViewWindow {
  readonly views: 'window';
  readonly nominalX: number;
  readonly nominalY: number;
  readonly xFrom: number;
  readonly xTo: number;
  readonly xStep: number;
  readonly yFrom: number;
  readonly yTo: number;
  readonly yStep: number;
  /** As of all directions. */
  readonly distance: number | null;
  readonly area: number;
}

/**
 * The constants of the film that the study's frames were taken on: how its display curves, how much it blurs, how much the
 * metal of each component takes away. With them an edge of a frame tells where the outline is.
 */
export interface Film {
  readonly stated: StatedFilm;
  /** Null until frames have told it. */
  readonly known: KnownFilm | null;
}

export const DISPLAYS = ['linear', 'between', 'logarithmic'] as const;

/** What a person fixed; null is estimated from the frames. */
export interface StatedFilm {
  readonly display: (typeof DISPLAYS)[number] | null;
  /** Px. */
  readonly blur: number | null;
  /** All of it, as a study file has it: then no frame is asked, and the two above say nothing. */
  readonly constants: FilmConstants | null;
}

export interface FilmConstants {
  /** One divided by grey values: 0 is linear, 1 / g shows g grey values for a factor of e. */
  readonly curvature: number;
  /** Px. */
  readonly blur: number;
  /** Of each component's metal, per mm; null where nobody knows. */
  readonly attenuation: Readonly<Record<ComponentName, number | null>>;
}

export const NOTHING_STATED: StatedFilm = { display: null, blur: null, constants: null };

export interface KnownFilm {
  /** As a person would say it, from the core, without a full stop. */
  readonly words: string;
  /** What was stated then. */
  readonly stated: StatedFilm;
  /** Px. */
  readonly blur: number;
  /** Curvature of the display times the contrast of metal; 0 where the constants were stated. */
  readonly curved: number;
  /** Profiles across outlines that were believed. */
  readonly profiles: number;
  readonly models: Readonly<Record<ComponentName, FilmModel | null>>;
}

/** What the film makes of a component; null where no frame of it has told. */
export interface FilmModel {
  /** SHA-256 of the component's model. */
  readonly of: string;
  /** Curvature, blur and attenuation, and their covariance row by row: twelve, as the core takes them. */
  readonly numbers: readonly number[];
}

export const UNKNOWN_FILM: Film = { stated: NOTHING_STATED, known: null };

/** What is known of one component in one frame. */
export interface Cell {
  readonly outline: Outline | null;
  readonly result: Result | null;
  /** The outline that the result belongs to: another object than `outline` while a new result is on its way. */
  readonly resultOf: Outline | null;
}

/** An open outline is a draft. */
export interface Outline {
  readonly points: readonly FramePoint[];
  readonly closed: boolean;
  /** Numbers of the sides that are not to be trusted, rising; side `i` runs from point `i` to the next. */
  readonly unknownSides: readonly number[];
  /** Missing: a hand. */
  readonly laidBy?: LaidBy;
}

export const LAID_BY = ['tool', 'mixed', 'mask', 'click'] as const;

/**
 * Who laid an outline on the frame where no hand did: a tool that follows edges, such a tool in part, a mask from which the frame is to be looked at,
 * or one click, whose outline is the model's silhouette. Edges lie off the implant's outline by what its film says.
 */
export type LaidBy = (typeof LAID_BY)[number];

export type Result = Posed | Failed;

export interface Posed {
  readonly kind: 'posed';
  /** What the pose was found from: a library match of the cell's outline, a file, somebody's hand, or the frames beside it. */
  readonly from: 'outline' | 'file' | 'hand' | 'film';
  /** Library and camera that found it (`libraryKey`), the file's name, how a pose set by hand was begun, or what it was followed from. */
  readonly origin: string;
  readonly candidates: readonly Candidate[];
  readonly chosen: number;
  /** Why the first candidate was chosen, in a sentence; null for poses of the library or a file. */
  readonly reason: string | null;
  /** Did anything speak for it besides a slightly smaller residual? Then other choices may rest on it. */
  readonly decided: boolean;
  /** On the first candidate, with what the others say; null where none was given: see `verdictOf`. */
  readonly verdict: Verdict | null;
  /** How bad a followed pose is: above 1 it is doubtful, and the worst have the most. */
  readonly doubt?: number;
  /** Of a pose that was followed from a doubtful one: what is said of it as soon as that one is doubtful no more. */
  readonly own?: Verdict;
  /** What the joint with the other component tells of it, whatever it is by itself: a sentence without its full stop. */
  readonly aside?: string;
  /** What the good poses in the frames beside it tell of it, where it does not go with them: such a sentence. */
  readonly detour?: string;
  /** Of a pose set by hand: the poses that had been found there, against which it is held. */
  readonly rivals?: readonly PoseNumbers[];
  /** The version of this program that worked it out; missing for what did not come from it. */
  readonly program?: string;
  /** Missing where the poses were brought onto an outline, not onto the edges of the frame itself. */
  readonly onFrame?: OnFrame;
}

/** How poses were brought onto the edges of a frame. */
export interface OnFrame {
  /** Curvature, blur and attenuation of its film; null where they were not known, and depth is off by millimetres. */
  readonly film: readonly number[] | null;
  /** Where a person clicked; missing where a box was drawn or the program found the component by itself. */
  readonly clickedAt?: FramePoint;
}

export interface Failed {
  readonly kind: 'failed';
  readonly origin: string;
  readonly sentence: string;
}

/** One pose with its score. Millimetres and degrees, the field's Z-X-Y order. */
export interface Candidate {
  readonly pose: PoseNumbers;
  /** Unmatched pixels in the canonical frame; null for a pose from a file or from a part of an outline. */
  readonly unmatched: number | null;
  /** Known frame pixels that differ from the outline when the model is drawn at the pose; null where it was not drawn. */
  readonly drawn: number | null;
  /** What remains between the outlines after refinement, px of the frame; null for a pose of the library or a file. */
  readonly residual: number | null;
  /** How uncertain the pose is; null for a pose of the library or a file, or one that is not determined. */
  readonly deviations: Uncertainty | null;
  /** How well it fits by itself; null where it was not compared with others. */
  readonly judged: Judged | null;
  /** Part of the model's outline that lies on edges of the frame, 0 to 1; missing where it was not measured. */
  readonly support?: number;
}

/** How far a pose is to be trusted, and why: a sentence without its full stop. Where nothing fits there is no pose. */
export interface Verdict {
  readonly word: 'good' | 'doubtful';
  readonly because: string;
}

export interface Judged {
  /** By what candidates are compared, px: beside the residual it counts outline that has no counterpart. */
  readonly misfit: number;
  /** Whatever other poses do. */
  readonly verdict: Verdict;
}

/** Grey values shown from black to white: centre -+ width / 2. */
export interface GreyWindow {
  readonly centre: number;
  readonly width: number;
}

export const EMPTY_CELL: Cell = { outline: null, result: null, resultOf: null };

export const DEFAULT_LIBRARY: LibrarySpec = { views: 'all directions', distance: null };

export const DEFAULT_WINDOW: ViewWindow = {
  views: 'window',
  nominalX: 0,
  nominalY: 0,
  xFrom: -15,
  xTo: 15,
  xStep: 1,
  yFrom: -20,
  yTo: 20,
  yStep: 1,
  distance: null,
  area: 15000,
};

const EMPTY_COMPONENT: Component = { model: null, libraryFile: null, librarySpec: DEFAULT_LIBRARY, axes: null };

export const EMPTY_DOC: Doc = {
  name: '',
  side: 'unknown',
  frames: [],
  unread: [],
  calibration: null,
  components: { femur: EMPTY_COMPONENT, tibia: EMPTY_COMPONENT },
  cells: Cells.NONE,
  window: null,
  reference: null,
  marks: {},
  distortion: null,
  rate: null,
  film: UNKNOWN_FILM,
  kneeDoubt: null,
  work: '',
};

export function cellKey(frameId: string, component: ComponentName): string {
  return `${frameId}/${component}`;
}

export function cellOf(doc: Doc, frameId: string | undefined, component: ComponentName): Cell {
  return (frameId === undefined ? null : doc.cells.at(frameId, component)) ?? EMPTY_CELL;
}

export function chosenCandidate(cell: Cell): Candidate | null {
  return cell.result?.kind === 'posed' ? (cell.result.candidates[cell.result.chosen] ?? null) : null;
}

/** A pose that somebody set stays until somebody changes it: nothing that the page works out takes its place. */
export function isByHand(result: Result | null): boolean {
  return result?.kind === 'posed' && result.from === 'hand';
}

/** Found by following the film, or not found by it. */
export function isFromFilm(result: Result | null): boolean {
  if (result === null) return false;
  return result.kind === 'posed' ? result.from === 'film' : result.origin.startsWith(FOLLOWED);
}

/** How the origin of what following gave begins; the frames that it was followed from come behind it. */
export const FOLLOWED = 'followed from';

/** On the pose that is chosen; null where none was given: poses of the library, of files, of old sessions. */
export function verdictOf(result: Result | null): Verdict | null {
  const told = result?.kind === 'posed' ? (result.aside ?? result.detour) : undefined;
  if (told !== undefined) return { word: 'doubtful', because: told };
  const verdict = verdictAlone(result);
  // That it fits is why there was a choice: which of them is right stays open until a person has accepted it.
  if (isTaken(result) && result.verdict && verdict?.word === 'good') return { word: 'doubtful', because: texts.follow.taken(result.verdict.word, result.verdict.because) };
  return verdict;
}

/** Did a person take another pose than the one that was chosen? */
export function isTaken(result: Result | null): result is Posed {
  return result?.kind === 'posed' && result.chosen !== 0;
}

/** The same without what its joint and its film tell: what is worked out from poses rests on them as they are by themselves. */
export function verdictAlone(result: Result | null): Verdict | null {
  if (result?.kind !== 'posed') return null;
  const taken = result.candidates[result.chosen];
  const unjudged = result.onFrame?.film && taken && !taken.judged ? UNMET : null;
  // Who took another one knows of the first.
  if (result.chosen === 0) return result.verdict ?? unjudged;
  return taken?.judged?.verdict ?? (taken && result.from === 'film' ? fixed(taken) : unjudged);
}

/** On a pose that its frame does not bear out. */
export const UNMET: Verdict = { word: 'doubtful', because: texts.film.unmet };

/** What a pose that a person fixed may leave beside the edges, px: as the core has it of those that lead following. */
const FIXED = 2;

/** Another pose than the one that following chose. */
function fixed({ residual }: Candidate): Verdict {
  const isBeside = residual !== null && residual > FIXED;
  return { word: isBeside ? 'doubtful' : 'good', because: texts.follow.fixed(isBeside ? residual : null) };
}

/** Were the poses brought onto the outline, or are they the library's? */
export function isRefined(result: Result | null): boolean {
  return result?.kind === 'posed' && result.candidates.some((candidate) => candidate.residual !== null);
}
