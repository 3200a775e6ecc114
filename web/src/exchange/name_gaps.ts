/**
 * What files that are numbered evenly but for gaps lack: poses of neighbours are taken to be near each other, and times to be even. By the rule of
 * the commands (`xtask/laboratory/src/files/listing.rs`).
 */
export interface Gaps {
  /** Files. */
  readonly missing: number;
  /** The names before and behind each gap. */
  readonly between: readonly (readonly [string, string])[];
}

/** Fewer files do not tell that one is missing among them. */
const ENOUGH = 4;

/** Of names in their order; null where nothing is told. */
export function gapsIn(names: readonly string[]): Gaps | null {
  const numbers = runningNumbers(names);
  if (!numbers || names.length < ENOUGH) return null;
  const steps = numbers.slice(1).map((number, at) => number - numbers[at]!);
  const step = Math.min(...steps);
  const even = steps.filter((other) => other === step).length;
  const gaps = steps.flatMap((other, at) => (other === step ? [] : [at]));
  const isEven = step > 0 && 2 * even > steps.length && steps.every((other) => other % step === 0);
  if (!isEven || gaps.length === 0) return null;
  const missing = gaps.reduce((sum, at) => sum + steps[at]! / step - 1, 0);
  return { missing, between: gaps.map((at) => [names[at]!, names[at + 1]!] as const) };
}

/** The number that tells names apart, where that is all that does. */
function runningNumbers(names: readonly string[]): readonly number[] | null {
  const all = names.map((name) => name.toLowerCase().split(/(\d+)/));
  const [first = []] = all;
  if (all.some((pieces) => pieces.length !== first.length)) return null;
  // Between words stand numbers, by their value.
  const isSame = (a: string, b: string, at: number) => (at % 2 === 1 ? Number(a) === Number(b) : a === b);
  const differing = first.flatMap((piece, at) => (all.every((pieces) => isSame(pieces[at]!, piece, at)) ? [] : [at]));
  const [at] = differing;
  if (at === undefined || differing.length > 1 || at % 2 === 0) return null;
  const numbers = all.map((pieces) => Number(pieces[at]));
  return numbers.every(Number.isSafeInteger) ? numbers : null;
}
