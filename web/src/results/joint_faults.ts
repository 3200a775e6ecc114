import { checkState, markOf } from '../document/marks';
import { cellOf, chosenCandidate, type Doc } from '../document/types';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { type Exporting, isOfBoth } from '../terms/exporting';
import { doubtOf } from './motion';
import { outdatedIn } from './outdated';

/** What somebody should know of poses before they are written: frames, by their numbers from 1. */
export interface PoseFaults {
  /** A component has no pose there. */
  readonly missing: readonly number[];
  /** A pose is the library's, or a hand's, and was not brought onto outline or frame. */
  readonly unrefined: readonly number[];
  /** A pose was read from a file, which does not say how it was found. */
  readonly unknown: readonly number[];
  /** It was found with another model, calibration or library. */
  readonly outdated: readonly number[];
  /** And nobody has accepted it. */
  readonly doubtful: readonly number[];
  /** Nobody has checked a pose as it is now. */
  readonly unchecked: readonly number[];
}

export const FAULTS = ['missing', 'unrefined', 'unknown', 'outdated', 'doubtful', 'unchecked'] as const satisfies readonly (keyof PoseFaults)[];

/** Whose faults are told together: of a joint both components', of poses each component's that the file has by themselves. */
export function toldTogether({ kind, forms, component }: Pick<Exporting, 'kind' | 'forms' | 'component'>): readonly (readonly ComponentName[])[] {
  if (kind !== 'poses') return [COMPONENT_NAMES];
  return isOfBoth(forms.poses) ? COMPONENT_NAMES.map((one) => [one]) : [[component]];
}

/** Of the poses of these components: of a joint, those of both. */
export function faultsOf(doc: Doc, components: readonly ComponentName[] = COMPONENT_NAMES): PoseFaults {
  const faults: Record<keyof PoseFaults, number[]> = { missing: [], unrefined: [], unknown: [], outdated: [], doubtful: [], unchecked: [] };
  const outdated = new Set(components.flatMap((component) => outdatedIn(doc, component)));
  doc.frames.forEach(({ id }, index) => {
    const note = (what: keyof PoseFaults, is: boolean) => is && faults[what].push(index + 1);
    const posed = components.flatMap((component) => {
      const cell = cellOf(doc, id, component);
      const candidate = chosenCandidate(cell);
      const mark = markOf(doc, { frameId: id, component });
      return candidate && cell.result?.kind === 'posed' ? [{ cell, candidate, result: cell.result, mark }] : [];
    });
    if (posed.length < components.length) return note('missing', true);
    note('unrefined', posed.some(({ candidate, result }) => candidate.residual === null && result.from !== 'file'));
    note('unknown', posed.some(({ result }) => result.from === 'file'));
    note('outdated', outdated.has(index));
    note('doubtful', posed.some(({ cell, mark }) => doubtOf(cell) !== null && checkState(cell, mark) !== 'yes'));
    note('unchecked', posed.some(({ cell, mark }) => checkState(cell, mark) !== 'yes'));
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
