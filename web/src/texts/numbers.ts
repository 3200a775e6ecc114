/** Numbers as they are shown; with a standard deviation, by the rule of report and commands (`core/report/src/plus_minus.rs`). */

/** A space that breaks no line. */
export const NARROW = '\u202f';

/**
 * As many decimals as the uncertainty is worth: two of its digits, but not more than usual, unless even its first digit
 * is smaller than that.
 */
export function decimalsFor(deviation: number | null, usual: number): number {
  if (deviation === null || !(deviation > 0)) return usual;
  const first = -Math.floor(Math.log10(deviation));
  return Math.max(0, Math.min(first + 1, Math.max(usual, first), usual + 1));
}

export function formatNumber(value: number, decimals: number): string {
  // A true minus sign is as wide as a digit's plus; "-0.00" is just zero.
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? (0).toFixed(decimals) : text.replace('-', '\u2212');
}

/** Never shown as none: the least that the decimals can say. */
export function formatDeviation(deviation: number, decimals: number): string {
  return Math.max(deviation, 10 ** -decimals).toFixed(decimals);
}

/** A number with one standard deviation: as many decimals as `decimalsFor` says, for both. A unit stands behind a space, a degree sign does not. */
export function plusMinus(value: number, deviation: number, usual: number): string {
  const decimals = decimalsFor(deviation, usual);
  return `${formatNumber(value, decimals)}${NARROW}±${NARROW}${formatDeviation(deviation, decimals)}`;
}

/** Thousands apart by a narrow space. */
export function grouped(value: number): string {
  return Math.round(value).toString().replace(/\B(?=(\d{3})+$)/g, '\u202f');
}
