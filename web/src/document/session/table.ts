import { cellOf, chosenCandidate, type Doc, isRefined, type Posed, type Result, verdictOf } from '../types';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import type { ComponentName } from '../../terms/component';

const FIELDS = ['x', 'y', 'z', 'zRot', 'xRot', 'yRot'] as const satisfies readonly (keyof PoseNumbers)[];

const HEAD = [
  'frame',
  'file',
  'x_mm',
  'y_mm',
  'z_mm',
  'z_rot_deg',
  'x_rot_deg',
  'y_rot_deg',
  'sd_x_mm',
  'sd_y_mm',
  'sd_z_mm',
  'sd_z_rot_deg',
  'sd_x_rot_deg',
  'sd_y_rot_deg',
  'residual_px',
  'verdict',
  'because',
  'method',
  'candidate',
  'candidates',
  'reason',
];

/**
 * Poses of a component as a table with commas (RFC 4180): a row a frame, the chosen pose, one standard deviation of
 * each number, how far it is to be trusted, and why it was chosen. What is not known is empty.
 */
export function poseTable(doc: Doc, component: ComponentName): string {
  const rows = doc.frames.map((frame, index) => {
    const cell = cellOf(doc, frame.id, component);
    const candidate = chosenCandidate(cell);
    const pose = FIELDS.map((field) => candidate?.pose[field] ?? null);
    const deviations = FIELDS.map((field) => candidate?.deviations?.[field] ?? null);
    return [index + 1, frame.name, ...pose, ...deviations, candidate?.residual ?? null, ...trustIn(cell.result), ...choiceOf(cell.result)];
  });
  return tableOf([HEAD, ...rows]);
}

/** How far a pose is to be trusted, as tables and audits have it. */
export interface VerdictRecord {
  readonly word: 'good' | 'doubtful' | 'none';
  readonly because: string;
}

/** The verdict, and why; where there is no pose, why not; null where nobody said. */
export function verdictRecord(result: Result | null): VerdictRecord | null {
  return result?.kind === 'failed' ? { word: 'none', because: result.sentence } : verdictOf(result);
}

function trustIn(result: Result | null): (string | null)[] {
  const { word = null, because = null } = verdictRecord(result) ?? {};
  return [word, because];
}

/** Method, number of the candidate from 1, how many there are, and the reason. */
function choiceOf(result: Result | null): (string | number | null)[] {
  if (result?.kind !== 'posed') return [null, null, null, null];
  const reason = result.chosen === 0 ? result.reason : 'Chosen by hand.';
  return [methodOf(result), result.chosen + 1, result.candidates.length, reason];
}

/** How a pose was found, in a few words. */
export function methodOf(result: Posed): string {
  const refined = isRefined(result);
  switch (result.from) {
    case 'file':
      return `file ${result.origin}`;
    case 'hand':
      return refined ? `by hand, refined${onFrameWords(result)}` : 'by hand';
    case 'film':
      return 'followed through the film';
    case 'outline':
      return refined ? `refined${onFrameWords(result)}` : 'library';
  }
}

/** Whether it was brought onto the frame itself, and whether its film was known: depth rests on that. */
function onFrameWords({ onFrame }: Posed): string {
  if (!onFrame) return '';
  return onFrame.film ? ' on the frame by its film' : ' on the frame, film unknown';
}

/** Rows with commas (RFC 4180). Text that a spreadsheet would take for a formula gets an apostrophe before it; numbers never. */
export function tableOf(rows: readonly (readonly (string | number | null)[])[]): string {
  return rows.map((row) => `${row.map(field).join(',')}\r\n`).join('');
}

function field(value: string | number | null): string {
  const text = typeof value === 'string' ? harmless(value) : String(value ?? '');
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

/** As `fluoropose_report::cell` has it: control characters are spaces, and some programs leave those out before they look. */
function harmless(text: string): string {
  const line = text.replace(/\p{Cc}/gu, ' ');
  return /^\s*[=+\-@＝＋－＠]/u.test(line) ? `'${line}` : line;
}
