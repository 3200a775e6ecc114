import { framePoint, type FramePoint } from '../../geometry/points';
import { COMPONENT_NAMES } from '../../terms/component';
import { LENGTH_UNITS } from '../../terms/length_unit';
import { readAudit, type Audit } from './audit';
import { readAxes } from '../axes';
import { checksum } from './checksum';
import { Cells } from '../cells';
import { readDistortion } from '../distortion';
import { readFilm } from '../film';
import { interned } from '../interned';
import { count, dictionary, flag, list, missingAs, nullable, number, object, oneOf, optional, ReadError, text, type Reader } from '../reader';
import {
  LAID_BY,
  type AllDirections,
  type Calibration,
  type Candidate,
  type Cell,
  cellKey,
  type Component,
  type Doc,
  type Failed,
  type FileReference,
  type ModelReference,
  type FrameEntry,
  type GreyWindow,
  type Judged,
  type KneeDoubt,
  type LibrarySpec,
  type Mark,
  type OnFrame,
  type Outline,
  type Posed,
  type Reference,
  type Result,
  type Verdict,
  type ViewWindow,
} from '../types';
import type { PoseNumbers, Uncertainty } from '../../geometry/pose_numbers';

/**
 * A session file: the whole document as JSON, every file it needs named by its SHA-256 and, unless the person chose
 * otherwise, included.
 */
export interface Session {
  readonly doc: Doc;
  readonly view: SessionView;
  readonly files: readonly SessionFile[];
  /** What gave the results, by digest; null in sessions of version 1. */
  readonly audit: Audit | null;
}

export interface SessionView {
  readonly frameIndex: number;
  readonly component: 'femur' | 'tibia';
  readonly overlayOpacity: number;
}

/** `bytes` is null for a file that is only referenced. */
export interface SessionFile {
  readonly name: string;
  readonly sha256: string;
  readonly bytes: Uint8Array<ArrayBuffer> | null;
}

export const SESSION_KIND = 'fluoropose-session';
export const SESSION_VERSION = 5;
/**
 * Version 1 had neither marks nor an audit, version 2 neither libraries of all directions nor verdicts, version 3 no
 * anatomical axes and no verdicts in its audit, version 4 no film.
 */
const OLDEST_VERSION = 1;

/** Parts of a blob: one long text may be more than a text can hold. */
export function writeSession(session: Session, program: string, savedAt: Date): string[] {
  const head = {
    kind: SESSION_KIND,
    version: SESSION_VERSION,
    program,
    savedAt: savedAt.toISOString(),
    view: session.view,
    audit: session.audit,
    document: plainDoc(session.doc),
  };
  const json = JSON.stringify(head);
  const opening = `${json.slice(0, -1)},\n"checksum":${checksum(json + namesOf(session.files))},\n"files":[`;
  const files = session.files.map((file, index) => `${index === 0 ? '' : ','}\n${writeFile(file)}`);
  return [opening, ...files, '\n]}\n'];
}

export function readSession(json: string): Session {
  const value = parse(json);
  if (value['kind'] !== SESSION_KIND) throw new ReadError('this JSON is not a fluoropose session (no "kind")');
  const version = number(value['version'], 'version');
  if (version < OLDEST_VERSION || version > SESSION_VERSION) {
    throw new ReadError(
      `this session has version ${version}; this page reads versions ${OLDEST_VERSION} to ${SESSION_VERSION}: open it with a newer page`,
    );
  }
  const session = {
    doc: readDoc(value['document'], 'document'),
    view: readView(value['view'], 'view'),
    files: list(readFile)(value['files'], 'files'),
    audit: optional(readAudit)(value['audit'], 'audit'),
  };
  // Last: what is wrong in itself is told by its place.
  if (value['checksum'] !== undefined) checkWhole(value, session.files);
  return session;
}

/**
 * Bits that were flipped on the way make other numbers, which nothing else would tell. Bytes of files have their SHA-256.
 * Sessions that were written before there was a checksum, or by others, have none.
 */
function checkWhole({ checksum: written, files: _, ...head }: Record<string, unknown>, files: readonly SessionFile[]): void {
  if (written === checksum(JSON.stringify(head) + namesOf(files))) return;
  throw new ReadError('the session was changed since it was saved (its checksum differs); whoever changes one on purpose takes the entry "checksum" out');
}

function namesOf(files: readonly SessionFile[]): string {
  return JSON.stringify(files.map(({ name, sha256 }) => [name, sha256]));
}

function parse(json: string): Record<string, unknown> {
  try {
    const value: unknown = JSON.parse(json);
    if (typeof value === 'object' && value !== null) return value as Record<string, unknown>;
  } catch (error) {
    throw new ReadError(`the session is cut short or damaged (${(error as Error).message})`);
  }
  throw new ReadError('the session is not a JSON object');
}

// --- Points are written as pairs: shorter, and easy to read elsewhere ----------------------------------------------

/** The document as JSON has it. Which work it is in this browser is of no use elsewhere. */
export function plainDoc({ work: _, ...doc }: Doc): Record<string, unknown> {
  const cells = doc.cells.entries().map(({ frameId, component, cell }) => [cellKey(frameId, component), plainCell(cell)]);
  return { ...doc, cells: Object.fromEntries(cells) };
}

export function plainCell({ outline, result, resultOf }: Cell): unknown {
  return { outline: plainOutline(outline), result, resultIsCurrent: result !== null && resultOf === outline };
}

function plainOutline(outline: Outline | null): unknown {
  return outline && { ...outline, points: outline.points.map((point) => [point.column, point.row]) };
}

const readPoint: Reader<FramePoint> = (value, path) => {
  const [column, row, ...rest] = list(number)(value, path);
  if (column === undefined || row === undefined || rest.length > 0) {
    throw new ReadError(`${path} should be a pair of numbers, column and row`);
  }
  return framePoint(column, row);
};

// --- The document --------------------------------------------------------------------------------------------------

const readOutline: Reader<Outline> = (value, path) => {
  // Sessions from before sides could be marked have none.
  const sides = missingAs<readonly number[]>([], list(count));
  const parts = object<Omit<Outline, 'laidBy'>>({ points: list(readPoint), closed: flag, unknownSides: sides })(value, path);
  // Sessions from before that was kept do not say it.
  const { laidBy } = object({ laidBy: optional(oneOf(...LAID_BY)) })(value, path);
  const outline: Outline = { ...parts, ...(laidBy !== null && { laidBy }) };
  const beyond = outline.unknownSides.find((side) => side >= outline.points.length);
  if (beyond !== undefined) throw new ReadError(`${path}.unknownSides names side ${beyond} of ${outline.points.length}`);
  return outline;
};

const readPose = object<PoseNumbers>({ x: number, y: number, z: number, zRot: number, xRot: number, yRot: number });

const readUncertainty: Reader<Uncertainty> = (value, path) => {
  // Sessions from before whole covariances were kept have none.
  const { covariance } = object({ covariance: optional(list(number)) })(value, path);
  return { ...readPose(value, path), ...(covariance && { covariance }) };
};

const readVerdict = object<Verdict>({ word: oneOf('good', 'doubtful'), because: text });

const readCandidateParts = object<Omit<Candidate, 'support'>>({
  pose: readPose,
  unmatched: nullable(number),
  drawn: nullable(number),
  // Sessions from before poses were refined do not have them.
  residual: optional(number),
  deviations: optional(readUncertainty),
  // Sessions of versions 1 and 2 have no verdicts.
  judged: optional(object<Judged>({ misfit: number, verdict: readVerdict })),
});

const readCandidate: Reader<Candidate> = (value, path) => {
  const { support } = object({ support: optional(number) })(value, path);
  return { ...readCandidateParts(value, path), ...(support !== null && { support }) };
};

const readPosedParts = object<Omit<Posed, 'program' | 'onFrame' | 'doubt' | 'own' | 'aside' | 'detour' | 'rivals'>>({
  kind: oneOf('posed'),
  from: oneOf('outline', 'file', 'hand', 'film'),
  origin: text,
  candidates: list(readCandidate),
  chosen: count,
  reason: optional(text),
  decided: missingAs(false, flag),
  verdict: optional(readVerdict),
});

const readPosed: Reader<Posed> = (value, path) => {
  const { program, onFrame, doubt, own, aside, detour, rivals } = readLater(value, path);
  const read = readPosedParts(value, path);
  // Where there is none, the first is chosen of none.
  if (read.chosen >= Math.max(1, read.candidates.length)) throw new ReadError(`${path}.chosen is ${read.chosen} of ${read.candidates.length}`);
  const parts = { ...read, origin: interned(read.origin) };
  const found = onFrame ?? (isByClick(parts) ? { film: null } : null);
  return { ...parts, ...(program !== null && { program }), ...(found && { onFrame: found }), ...(doubt !== null && { doubt }), ...(own && { own }), ...(aside !== null && { aside }), ...(detour !== null && { detour }), ...(rivals && { rivals }) };
};

const readOnFrame: Reader<OnFrame> = (value, path) => {
  const { film, clickedAt } = object({ film: nullable(list(number)), clickedAt: optional(object({ column: number, row: number })) })(value, path);
  return { film, ...(clickedAt && { clickedAt: framePoint(clickedAt.column, clickedAt.row) }) };
};

/** What came into sessions afterwards. */
const readLater = object({ program: optional(text), onFrame: optional(readOnFrame), doubt: optional(number), own: optional(readVerdict), aside: optional(text), detour: optional(text), rivals: optional(list(readPose)) });

/** Sessions of versions 1 to 4 do not say it: what was refined and never drawn against an outline came of one click. */
function isByClick({ from, candidates }: Pick<Posed, 'from' | 'candidates'>): boolean {
  return from === 'outline' && candidates.length > 0 && candidates.every(({ residual, drawn, unmatched }) => residual !== null && drawn === null && unmatched === null);
}

const readFailed = object<Failed>({ kind: oneOf('failed'), origin: text, sentence: text });

const readResult: Reader<Result> = (value, path) => {
  const kind = object({ kind: oneOf('posed', 'failed') })(value, path).kind;
  return kind === 'posed' ? readPosed(value, path) : readFailed(value, path);
};

const readPlainCell = object<{ outline: Outline | null; result: Result | null; resultIsCurrent: boolean }>({
  outline: nullable(readOutline),
  result: nullable(readResult),
  resultIsCurrent: flag,
});

const readCell: Reader<Cell> = (value, path) => {
  const { outline: read, result, resultIsCurrent } = readPlainCell(value, path);
  const outline = read && resultIsCurrent && !read.laidBy && isOfClick(result) ? { ...read, laidBy: 'click' as const } : read;
  return { outline, result, resultOf: result !== null && resultIsCurrent ? outline : null };
};

/** Before outlines kept who laid them, those of poses that were found on a frame came of one click. */
function isOfClick(result: Result | null): boolean {
  return result?.kind === 'posed' && result.from === 'outline' && result.onFrame !== undefined;
}

const readCells: Reader<Cells<Cell>> = (value, path) => {
  const cells = Object.entries(dictionary(readCell)(value, path));
  const stray = cells.find(([key]) => !CELL_KEY.test(key));
  if (stray) throw new ReadError(`${path} names ${JSON.stringify(stray[0].slice(0, 40))}, which is no frame and component`);
  return Cells.from(cells);
};

/** As `cellKey` makes it. */
const CELL_KEY = new RegExp(`^.+/(?:${COMPONENT_NAMES.join('|')})$`, 's');

const readFrame = object<FrameEntry>({
  id: text,
  name: text,
  source: text,
  indexInSource: count,
  width: count,
  height: count,
});

const readReference = object<FileReference>({ name: text, sha256: text });

const readWritten = object({ writtenFrom: optional(object({ name: text, unit: oneOf(...LENGTH_UNITS), sha256: optional(text) })) });

const readModel: Reader<ModelReference> = (value, path) => {
  const { writtenFrom } = readWritten(value, path);
  if (!writtenFrom) return readReference(value, path);
  const { sha256, ...named } = writtenFrom;
  return { ...readReference(value, path), writtenFrom: { ...named, ...(sha256 !== null && { sha256 }) } };
};

const readAllDirections = object<AllDirections>({ views: oneOf('all directions'), distance: nullable(number) });

const readWindow = object<ViewWindow>({
  // Sessions of versions 1 and 2 know windows alone.
  views: missingAs('window', oneOf('window')),
  nominalX: number,
  nominalY: number,
  xFrom: number,
  xTo: number,
  xStep: number,
  yFrom: number,
  yTo: number,
  yStep: number,
  distance: nullable(number),
  area: count,
});

const readSpec: Reader<LibrarySpec> = (value, path) => {
  const { views } = object({ views: missingAs('window', oneOf('all directions', 'window')) })(value, path);
  return views === 'window' ? readWindow(value, path) : readAllDirections(value, path);
};

const readComponent = object<Component>({
  model: nullable(readModel),
  libraryFile: nullable(readReference),
  librarySpec: readSpec,
  // Sessions of versions 1 to 3 have none: the shape is asked.
  axes: optional(readAxes),
});

/** Sessions from before poses could be compared have none. */
const readPosesToCompare = optional(object<Reference>({ name: text, poses: dictionary(readPose) }));

const readMark = object<Mark>({ checked: nullable(text), flagged: flag, note: text });

const readDocParts = object<Omit<Doc, 'work'>>({
  name: text,
  side: oneOf('left', 'right', 'unknown'),
  frames: list(readFrame),
  // Sessions from before these two were kept have none.
  unread: missingAs([], list(text)),
  calibration: nullable(object<Calibration>({ name: text, text })),
  components: object({ femur: readComponent, tibia: readComponent }),
  cells: readCells,
  window: nullable(object<GreyWindow>({ centre: number, width: number })),
  reference: readPosesToCompare,
  marks: missingAs({}, dictionary(readMark)),
  // Sessions from before distortion could be corrected have none.
  distortion: optional(readDistortion),
  // Sessions from before the speed of the film was kept do not say it.
  rate: optional(number),
  film: readFilm,
  kneeDoubt: optional(object<KneeDoubt>({ models: text, sentence: text })),
});

/** The reverse of `plainDoc`. */
export const readDoc: Reader<Doc> = (value, path) => ({ ...readDocParts(value, path), work: '' });

export const readView = object<SessionView>({
  frameIndex: count,
  component: oneOf('femur', 'tibia'),
  overlayOpacity: number,
});

// --- Files ---------------------------------------------------------------------------------------------------------

function writeFile(file: SessionFile): string {
  const base64 = file.bytes && encodeBase64(file.bytes);
  return JSON.stringify({ name: file.name, sha256: file.sha256, base64 });
}

const readFile: Reader<SessionFile> = (value, path) => {
  const { name, sha256, base64 } = object({ name: text, sha256: text, base64: nullable(text) })(value, path);
  return { name, sha256, bytes: base64 === null ? null : decodeBase64(base64, `${path} (${name})`) };
};

/** Pieces whose length is a multiple of three can be encoded apart. */
const PIECE = 3 * 8192;

export function encodeBase64(bytes: Uint8Array): string {
  const pieces: string[] = [];
  for (let start = 0; start < bytes.length; start += PIECE) {
    pieces.push(btoa(String.fromCharCode(...bytes.subarray(start, start + PIECE))));
  }
  return pieces.join('');
}

export function decodeBase64(base64: string, path: string): Uint8Array<ArrayBuffer> {
  try {
    return Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
  } catch {
    throw new ReadError(`${path}: the included file is damaged (not base64)`);
  }
}
