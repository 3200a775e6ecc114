import { CONSTANTS, filmNumbers, squareOf } from '../document/film';
import { checkState, markOf } from '../document/marks';
import { methodOf, tableOf } from '../document/session/table';
import { type Candidate, type Cell, cellOf, chosenCandidate, type Doc, isTaken, type Posed, verdictAlone, verdictOf } from '../document/types';
import { doubtOf } from '../results/motion';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { texts } from '../texts/texts';

/** Poses as `track` writes them: a folder that the commands take, with what a person did as two columns more. */

/** A row for each cell with a pose, or that was looked for one: what became of it. */
export function statesOf(doc: Doc): string {
  const rows = doc.frames.flatMap((frame, index) =>
    COMPONENT_NAMES.flatMap((component) => {
      const cell = cellOf(doc, frame.id, component);
      if (!cell.result) return [];
      const isChecked = checkState(cell, markOf(doc, { frameId: frame.id, component })) === 'yes';
      const { residual = null } = chosenCandidate(cell) ?? {};
      const found = [...stateOf(cell, isChecked), ...numbersOf(chosenCandidate(cell)), residual, badnessOf(cell), frame.name, frame.indexInSource + 1];
      const method = cell.result.kind === 'posed' ? methodOf(cell.result) : null;
      return [[index + 1, component, ...found, method, Number(isChecked)]];
    }),
  );
  return tableOf([HEAD, ...rows]);
}

/** All files of the folder by their names. `jts`: the poses of each component. */
export function trackedFiles(doc: Doc, jts: Readonly<Record<ComponentName, string>>): readonly (readonly [string, string])[] {
  const files = COMPONENT_NAMES.flatMap((component) => [
    [`${component}.jts`, jts[component]] as const,
    [`${component}.covariances.csv`, covariancesOf(doc, component)] as const,
  ]);
  return [...files, ['track.csv', statesOf(doc)], ['film.csv', constantsOf(doc)]];
}

const FIELDS = ['x', 'y', 'z', 'zRot', 'xRot', 'yRot'] as const;
const UNITS = ['x_mm', 'y_mm', 'z_mm', 'z_rot_deg', 'x_rot_deg', 'y_rot_deg'];
const HEAD = ['frame', 'component', 'state', 'verdict', 'because', ...UNITS, ...UNITS.map((name) => `sd_${name}`), 'misfit_px', 'badness', 'file', 'frame_of_file', 'method', 'checked'];

/** State, verdict and reason. Fixed is what a person gave: by hand, from a file, by choice or by a check; what a click or an outline led to is found. */
function stateOf(cell: Cell, isChecked: boolean): readonly string[] {
  const { result } = cell;
  if (result?.kind !== 'posed') return ['no pose', 'none', result?.sentence ?? ''];
  const doubt = doubtOf(cell);
  if (doubt !== null && isChecked) return ['fixed', 'good', texts.follow.accepted(doubt)];
  if (doubt !== null) return [isTaken(result) && verdictAlone(result)?.word === 'good' ? 'fixed' : 'doubtful', 'doubtful', doubt];
  const verdict = verdictOf(result);
  // What nobody and nothing has held against the frame is not good yet.
  if (result.chosen === 0 && !verdict && !isChecked) return [isGivenBy(result) ? 'fixed' : 'found', 'none', texts.follow.notJudged];
  const isGiven = isChecked || isGivenBy(result) || result.chosen !== 0;
  const because = (result.chosen === 0 && verdict?.because) || texts.follow.fixed(null);
  return [isGiven ? 'fixed' : result.from === 'film' ? 'followed' : 'found', 'good', because];
}

/** How much speaks against a pose that was followed. */
function badnessOf({ result }: Cell): number | null {
  return result?.kind === 'posed' && result.chosen === 0 ? (result.doubt ?? null) : null;
}

function isGivenBy({ from }: Posed): boolean {
  return from === 'hand' || from === 'file';
}

function numbersOf(candidate: Candidate | null): readonly (number | null)[] {
  return [candidate?.pose, candidate?.deviations].flatMap((numbers) => FIELDS.map((field) => numbers?.[field] ?? null));
}

/** The constants of the film as each component is seen on it, with one standard deviation of each; what is stated has none. */
function constantsOf(doc: Doc): string {
  const rows = COMPONENT_NAMES.flatMap((component) => {
    const numbers = filmNumbers(doc, component);
    if (!numbers) return [];
    const side = squareOf(numbers);
    const values = [numbers[0]!, numbers[1]! * side, numbers[2]!];
    // Of blur and attenuation the logarithm's deviation is known.
    const deviation = (k: number) => Math.sqrt(Math.max(0, numbers[CONSTANTS + 4 * k] ?? 0)) * (k === 0 ? 1 : values[k]!);
    const [amount = 0, radius = 0] = numbers.slice(CONSTANTS + 9);
    return [[component, ...values.flatMap((value, k) => [value, deviation(k)]), amount, radius * side, side]];
  });
  return tableOf([FILM_HEAD, ...rows]);
}

const FILM_HEAD = ['component', 'curvature_a_grey_value', 'sd_curvature', 'blur_px', 'sd_blur_px', 'attenuation_a_mm', 'sd_attenuation_a_mm', 'edges_enhanced', 'enhanced_within_px', 'square_px'];

const SIX = [0, 1, 2, 3, 4, 5] as const;
/** Numbers of the upper half of a covariance, and of what is the film's. */
const UPPER = 21;
const FILM = 12;

/** Rows of frames whose covariance is kept: 36 numbers, and how the pose moves with each of two constants of the film. */
function covariancesOf(doc: Doc, component: ComponentName): string {
  const head = ['frame', ...SIX.flatMap((row) => SIX.map((column) => `c${row + 1}${column + 1}`)), ...[1, 2].flatMap((constant) => SIX.map((k) => `film${constant}_${k + 1}`))];
  const rows = doc.frames.flatMap(({ id }, index) => {
    const covariance = chosenCandidate(cellOf(doc, id, component))?.deviations?.covariance ?? [];
    const [upper, film] = [covariance.slice(0, UPPER), covariance.slice(UPPER, UPPER + FILM)];
    if (upper.length < UPPER || !upper.every(Number.isFinite)) return [];
    return [[index + 1, ...wholeOf(upper), ...(film.length === FILM && film.every(Number.isFinite) ? film : [])]];
  });
  return tableOf([head, ...rows]);
}

/** A symmetric matrix, row by row, of its upper half. */
function wholeOf(upper: readonly number[]): readonly number[] {
  const at = (row: number, column: number) => upper[row * 6 - (row * (row - 1)) / 2 + column - row]!;
  return SIX.flatMap((row) => SIX.map((column) => at(Math.min(row, column), Math.max(row, column))));
}
