import { digestOf } from '../digest';
import { count, list, nullable, number, object, oneOf, optional, text, type Reader } from '../reader';
import { methodOf, verdictRecord, type VerdictRecord } from './table';
import { cellOf, type Doc, type FrameEntry, type Outline, type Posed } from '../types';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import { COMPONENT_NAMES, type ComponentName } from '../../terms/component';

/**
 * What gave each result, so that somebody else can get it again: the digest of every input, the method, and the
 * version of the program that worked it out. A session carries it; who opens the session is told what does not match.
 */
export interface Audit {
  readonly inputs: readonly InputDigest[];
  readonly results: readonly ResultRecord[];
}

export interface InputDigest {
  readonly role: Role;
  readonly name: string;
  /** SHA-256, hexadecimal; of a calibration's text in UTF-8. */
  readonly sha256: string;
}

const ROLES = ['frames', 'calibration', 'femur model', 'femur library', 'tibia model', 'tibia library'] as const;
export type Role = (typeof ROLES)[number];

export interface ResultRecord {
  /** The frame's identity in the document. */
  readonly frame: string;
  readonly name: string;
  /** Place in the sequence, from 1. */
  readonly number: number;
  readonly component: ComponentName;
  readonly method: string;
  /** The version that worked it out; null for a pose that came from a file or another hand. */
  readonly program: string | null;
  /** Model, library and camera (`poseKey`), or the file's name. */
  readonly origin: string;
  /** Of the outline as `outlineText` writes it; null without one. */
  readonly outlineSha256: string | null;
  /** Candidate that was chosen, from 1, and of how many; 0 where there is no pose. */
  readonly candidate: number;
  readonly candidates: number;
  readonly reason: string | null;
  /** How far it is to be trusted, and why; null where nobody said: poses of the library, of files, of old sessions. */
  readonly verdict: VerdictRecord | null;
  /** Mm and degrees; null where nothing fits. */
  readonly pose: PoseNumbers | null;
  readonly deviations: PoseNumbers | null;
  /** Px. */
  readonly residual: number | null;
}

export async function auditOf(doc: Doc): Promise<Audit> {
  const results: ResultRecord[] = [];
  for (const [index, frame] of doc.frames.entries()) {
    for (const component of COMPONENT_NAMES) {
      const record = await recordOf(doc, frame, index, component);
      if (record) results.push(record);
    }
  }
  return { inputs: await inputsOf(doc), results };
}

async function inputsOf(doc: Doc): Promise<InputDigest[]> {
  const inputs = new Map<string, InputDigest>();
  for (const { name, source } of doc.frames) {
    inputs.set(source, { role: 'frames', name: name.replace(/ #\d+$/, ''), sha256: source });
  }
  const found = [...inputs.values()];
  const { calibration } = doc;
  if (calibration) found.push({ role: 'calibration', name: calibration.name, sha256: await textDigest(calibration.text) });
  for (const component of COMPONENT_NAMES) {
    const { model, libraryFile } = doc.components[component];
    if (model) found.push({ role: `${component} model`, ...model });
    if (libraryFile) found.push({ role: `${component} library`, ...libraryFile });
  }
  return found;
}

async function recordOf(doc: Doc, frame: FrameEntry, index: number, component: ComponentName): Promise<ResultRecord | null> {
  const { result, resultOf } = cellOf(doc, frame.id, component);
  if (!result) return null;
  return {
    frame: frame.id,
    name: frame.name,
    number: index + 1,
    component,
    origin: result.origin,
    outlineSha256: resultOf && (await outlineDigest(resultOf)),
    verdict: verdictRecord(result),
    ...(result.kind === 'posed' ? poseRecord(result) : NO_POSE),
  };
}

type PoseRecord = Pick<ResultRecord, 'method' | 'program' | 'candidate' | 'candidates' | 'reason' | 'pose' | 'deviations' | 'residual'>;

const NO_POSE: PoseRecord = { method: 'none', program: null, candidate: 0, candidates: 0, reason: null, pose: null, deviations: null, residual: null };

function poseRecord(result: Posed): PoseRecord {
  const { pose = null, deviations = null, residual = null } = result.candidates[result.chosen] ?? {};
  return {
    method: methodOf(result),
    program: result.program ?? null,
    candidate: result.chosen + 1,
    candidates: result.candidates.length,
    reason: reasonOf(result),
    pose,
    deviations: deviations && sixOf(deviations),
    residual,
  };
}

/** The document has the covariance too. */
function sixOf({ x, y, z, zRot, xRot, yRot }: PoseNumbers): PoseNumbers {
  return { x, y, z, zRot, xRot, yRot };
}

function reasonOf(result: Posed): string | null {
  return result.chosen === 0 ? result.reason : 'Chosen by hand.';
}

/**
 * Sentences about what is not as it was when the audit was written, with its name; empty where everything matches.
 * Files are not looked at here: their digests are checked when they are opened.
 */
export async function auditTroubles(doc: Doc, audit: Audit): Promise<string[]> {
  const now = await auditOf(doc);
  return [...inputTroubles(audit, now), ...resultTroubles(audit, now)];
}

function inputTroubles(then: Audit, now: Audit): string[] {
  const key = ({ role, name, sha256 }: InputDigest) => `${role} ${name} ${sha256}`;
  const present = new Set(now.inputs.map(key));
  return then.inputs
    .filter((input) => !present.has(key(input)))
    .map((input) => {
      const { role, name, sha256 } = input;
      const other = now.inputs.find((candidate) => candidate.role === role && candidate.name === name);
      const what = role === 'frames' ? `The frames ${name}` : `The ${role} ${name}`;
      return other
        ? `${what}: SHA-256 ${short(other.sha256)} in the session, ${short(sha256)} when its results were saved`
        : `${what} (SHA-256 ${short(sha256)}) gave results of this session but is no longer named in it`;
    });
}

function resultTroubles(then: Audit, now: Audit): string[] {
  const present = new Map(now.results.map((record) => [`${record.frame} ${record.component}`, record]));
  const sentences: string[] = [];
  for (const before of then.results) {
    const after = present.get(`${before.frame} ${before.component}`);
    const what = changed(before, after);
    if (what) sentences.push(`Frame ${before.number} (${before.name}), ${before.component}: ${what} after the session was saved`);
  }
  return sentences;
}

function changed(before: ResultRecord, after: ResultRecord | undefined): string | null {
  if (!after || (before.pose && !after.pose)) return 'the pose was taken out';
  if (before.outlineSha256 !== after.outlineSha256) return 'the outline was changed';
  if (JSON.stringify(before.pose) !== JSON.stringify(after.pose)) return 'the pose was changed';
  return before.origin === after.origin ? null : 'what the pose was found with was changed';
}

/** The first digits: enough to tell two apart. */
function short(sha256: string): string {
  return `${sha256.slice(0, 12)}...`;
}

/** What the digest of an outline is taken of: `closed`, the points as pairs, the unknown sides, as JSON without spaces. */
export function outlineText({ closed, points, unknownSides }: Outline): string {
  return JSON.stringify({ closed, points: points.map(({ column, row }) => [column, row]), unknownSides });
}

function outlineDigest(outline: Outline): Promise<string> {
  return textDigest(outlineText(outline));
}

function textDigest(content: string): Promise<string> {
  return digestOf(new TextEncoder().encode(content));
}

// --- Reading ------------------------------------------------------------------------------------------------------

const readPose = object<PoseNumbers>({ x: number, y: number, z: number, zRot: number, xRot: number, yRot: number });

const readInput = object<InputDigest>({ role: oneOf(...ROLES), name: text, sha256: text });

const readRecord = object<ResultRecord>({
  frame: text,
  name: text,
  number: count,
  component: oneOf('femur', 'tibia'),
  method: text,
  program: optional(text),
  origin: text,
  outlineSha256: nullable(text),
  candidate: count,
  candidates: count,
  reason: nullable(text),
  // Audits of versions 2 and 3 have no verdicts, and say nothing of what has no pose.
  verdict: optional(object<VerdictRecord>({ word: oneOf('good', 'doubtful', 'none'), because: text })),
  pose: nullable(readPose),
  deviations: nullable(readPose),
  residual: nullable(number),
});

export const readAudit: Reader<Audit> = object<Audit>({ inputs: list(readInput), results: list(readRecord) });
