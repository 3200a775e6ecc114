/** Ends work in the page in every way, again and again, and tells what was lost: `cargo xtask kill` starts it. */
import { writeFile } from 'node:fs/promises';
import { argv, exit } from 'node:process';
import { browser, IN_FIREFOX } from '../support/browser.mjs';
import { ENDS, WITHOUT_DEBUGGER } from './ends.mjs';

/** @typedef {{ trials: number, edits: number, unsaved: number, broughtBack: number, lost: number, undecided: number }} Row */

const SIDE_BY_SIDE = 2;

const [, , trials = '200', seed = '1', chosen = '', file = ''] = argv;
const names = Object.keys(ENDS).filter((name) => name.includes(chosen) && (!IN_FIREFOX || WITHOUT_DEBUGGER.includes(name)));
/** @type {Record<string, Row>} */
const rows = Object.fromEntries(names.map((name) => [name, { trials: 0, edits: 0, unsaved: 0, broughtBack: 0, lost: 0, undecided: 0 }]));
let next = 0;

await Promise.all(Array.from({ length: SIDE_BY_SIDE }, worker));
await (await browser()).close();
const total = Object.values(rows).reduce((sum, row) => add(sum, row), { trials: 0, edits: 0, unsaved: 0, broughtBack: 0, lost: 0, undecided: 0 });
print({ ...rows, all: total });
if (file) await writeFile(file, JSON.stringify({ rows, total }));
exit(total.lost + total.undecided > 0 ? 1 : 0);

async function worker() {
  while (next < Number(trials)) {
    const index = next++;
    await trial(names[index % names.length], index);
  }
}

/** @param {string} name @param {number} index */
async function trial(name, index) {
  const row = rows[name];
  const words = `trial ${index + 1}, ${name}`;
  row.trials++;
  /** @type {import('./ends.mjs').Ended} */
  let ended;
  try {
    ended = await ENDS[name](randomOf(Number(seed) * 1_000_003 + index), `work ${index + 1}`);
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

/** @param {Row} a @param {Row} b @returns {Row} */
function add(a, b) {
  return /** @type {Row} */ (Object.fromEntries(Object.keys(a).map((key) => [key, a[/** @type {keyof Row} */ (key)] + b[/** @type {keyof Row} */ (key)]])));
}

/** @param {Record<string, Row>} table */
function print(table) {
  console.log(`${'how it ended'.padEnd(22)} trials  edits  not yet saved  of these back  lost  undecided`);
  for (const [name, { trials, edits, unsaved, broughtBack, lost, undecided }] of Object.entries(table)) {
    const cells = [[trials, 6], [edits, 7], [unsaved, 15], [broughtBack, 15], [lost, 6], [undecided, 11]];
    console.log(name.padEnd(22) + cells.map(([value, width]) => String(value).padStart(width)).join(''));
  }
}

/** Mulberry32: the same trial with the same seed. @param {number} seed */
function randomOf(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 4294967296;
  };
}
