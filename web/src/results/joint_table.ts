import { checkState, markOf } from '../document/marks';
import { methodOf, tableOf, verdictRecord } from '../document/session/table';
import { cellOf, chosenCandidate, type Doc } from '../document/types';
import { COMPONENT_NAMES } from '../terms/component';
import { PROGRAM } from '../terms/program';
import type { JointNumbers } from './joint_curves';
import { jointTrusts } from './motion';

/** What stands above the columns: the same for whoever reads it with whatever program, so in no other language than English. */
function heading(doc: Doc): readonly string[] {
  return [
    `${PROGRAM}, joint table of the page, version 1`,
    `study: ${doc.name.replaceAll(/[\r\n]/g, ' ')}; knee: ${doc.side}; frames are numbered as in the film, from 1; empty where a component has no pose`,
    "units: mm, degrees (deg), percent of the tray's anterior-posterior extent from its posterior border",
    "field_*: origin of the femoral component in the axes of the tibial one; flexion, abduction, internal rotation: tibia against femur, z-x-y, which is Grood and Suntay's sequence",
    'gs_*: shift of the tibial origin from the femoral one along the axes of Grood and Suntay 1983',
    "medial_*, lateral_*: lowest points of the femoral component above the tray's plate, from the plate's middle, anterior and medial positive; lift_off: lateral less medial height",
    'sd_*: one standard deviation, the errors of the numbers of both poses taken as independent',
    'filter: none',
  ];
}

/**
 * The numbers of a joint as a table with commas (RFC 4180) below lines that begin with `#`: a row a frame, with how far either
 * pose is to be trusted. What is not known is empty. `rate`: frames a second; NaN where nobody said.
 */
export function jointTable(doc: Doc, numbers: JointNumbers, rate: number): string {
  const timed = rate > 0;
  const of = (name: string) => COMPONENT_NAMES.map((component) => `${component}_${name}`);
  const head = ['frame', 'file', ...(timed ? ['time_s'] : []), ...numbers.columns, ...of('verdict'), ...of('because'), ...of('checked'), ...of('method')];
  const rows = doc.frames.map(({ id, name }, index) => {
    const row = numbers.of.get(id);
    const found = numbers.columns.map((_, column) => (row && Number.isFinite(row[column]) ? row[column]! : null));
    const cells = COMPONENT_NAMES.map((component) => ({ cell: cellOf(doc, id, component), mark: markOf(doc, { frameId: id, component }) }));
    const verdicts = cells.map(({ cell }) => verdictRecord(cell.result));
    const checked = cells.map(({ cell, mark }) => (chosenCandidate(cell) ? checkState(cell, mark) : null));
    const methods = cells.map(({ cell }) => (cell.result?.kind === 'posed' ? methodOf(cell.result) : null));
    const time = timed ? [index / rate] : [];
    return [index + 1, name, ...time, ...found, ...verdicts.map((verdict) => verdict?.word ?? null), ...verdicts.map((verdict) => verdict?.because ?? null), ...checked, ...methods];
  });
  return heading(doc).map((line) => `# ${line}\r\n`).join('') + tableOf([head, ...rows]);
}

/** What somebody should know of a table before it is written: frames, by their numbers from 1. */
export interface TableFaults {
  /** A component has no pose. */
  readonly missing: readonly number[];
  /** A pose is the library's, or a hand's, and was not brought onto outline or frame. */
  readonly unrefined: readonly number[];
  /** A pose was read from a file, which does not say how it was found. */
  readonly unknown: readonly number[];
  readonly doubtful: readonly number[];
  /** Nobody has checked a pose as it is now. */
  readonly unchecked: readonly number[];
}

export const FAULTS = ['missing', 'unrefined', 'unknown', 'doubtful', 'unchecked'] as const satisfies readonly (keyof TableFaults)[];

export function faultsOf(doc: Doc): TableFaults {
  const trusts = jointTrusts(doc);
  const faults: Record<keyof TableFaults, number[]> = { missing: [], unrefined: [], unknown: [], doubtful: [], unchecked: [] };
  doc.frames.forEach(({ id }, index) => {
    const note = (what: keyof TableFaults, is: boolean) => is && faults[what].push(index + 1);
    const posed = COMPONENT_NAMES.flatMap((component) => {
      const cell = cellOf(doc, id, component);
      const candidate = chosenCandidate(cell);
      return candidate && cell.result?.kind === 'posed' ? [{ candidate, result: cell.result }] : [];
    });
    if (posed.length < COMPONENT_NAMES.length) return note('missing', true);
    const { doubtful, checked } = trusts[index]!;
    note('unrefined', posed.some(({ candidate, result }) => candidate.residual === null && result.from !== 'file'));
    note('unknown', posed.some(({ result }) => result.from === 'file'));
    note('doubtful', doubtful);
    note('unchecked', !checked);
    return undefined;
  });
  return faults;
}

/** Numbers from 1 in words: runs with a dash, and of many the first. */
export function inRuns(numbers: readonly number[], most = 6): string {
  const runs: [number, number][] = [];
  for (const number of numbers) {
    const run = runs.at(-1);
    if (run && run[1] === number - 1) run[1] = number;
    else runs.push([number, number]);
  }
  const words = runs.slice(0, most).map(([first, last]) => (first === last ? `${first}` : `${first}\u2013${last}`));
  return words.join(', ') + (runs.length > most ? ' \u2026' : '');
}
