/** Kinds of ends by turns, each after work that its seed tells, and what became of that. */
import { randomOf } from '../support/random.mjs';
import { ENDS } from './ends.mjs';

/** @typedef {{ trials: number, edits: number, unsaved: number, broughtBack: number, lost: number, undecided: number }} Row */

/** @returns {Row} */
export function emptyRow() {
  return { trials: 0, edits: 0, unsaved: 0, broughtBack: 0, lost: 0, undecided: 0 };
}

/** Does work, ends it, looks for it, and counts that in the row. @param {string} name of the end @param {number} index of the trial @param {number} seed @param {Row} row */
export async function trial(name, index, seed, row) {
  const words = `trial ${index + 1}, ${name}`;
  row.trials++;
  /** @type {import('./ends.mjs').Ended} */
  let ended;
  try {
    ended = await ENDS[name](randomOf(seed * 1_000_003 + index), `work ${index + 1}`);
  } catch (error) {
    // The trial did not come to its end: nothing is known, which is no success.
    row.undecided++;
    console.log(`${words}: did not come so far: ${error instanceof Error ? error.message : error}`);
    return;
  }
  for (const { work, page } of ended) {
    row.edits += work.edits;
    try {
      const { unsaved, broughtBack } = await work.isIn(page);
      row.unsaved += unsaved;
      row.broughtBack += broughtBack;
    } catch (error) {
      row.lost++;
      console.log(`${words}: LOST: ${error instanceof Error ? error.message : error}`);
    }
  }
  for (const context of new Set(ended.map(({ page }) => page.context()))) await context.close();
}

/** Of all rows together. @param {readonly Row[]} rows @returns {Row} */
export function totalOf(rows) {
  return rows.reduce(add, emptyRow());
}

/** @param {Row} a @param {Row} b @returns {Row} */
function add(a, b) {
  return /** @type {Row} */ (Object.fromEntries(Object.keys(a).map((key) => [key, a[/** @type {keyof Row} */ (key)] + b[/** @type {keyof Row} */ (key)]])));
}
