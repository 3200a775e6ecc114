/** Ends work in the page in every way, again and again, and tells what was lost: `cargo xtask kill` starts it. */
import { writeFile } from 'node:fs/promises';
import { argv, exit } from 'node:process';
import { browser, IN_FIREFOX } from '../support/browser.mjs';
import { ENDS, WITHOUT_DEBUGGER } from './ends.mjs';
import { emptyRow, totalOf, trial } from './trial.mjs';

/** @typedef {import('./trial.mjs').Row} Row */

const SIDE_BY_SIDE = 2;

const [, , trials = '200', seed = '1', chosen = '', file = ''] = argv;
const names = Object.keys(ENDS).filter((name) => name.includes(chosen) && (!IN_FIREFOX || WITHOUT_DEBUGGER.includes(name)));
/** @type {Record<string, Row>} */
const rows = Object.fromEntries(names.map((name) => [name, emptyRow()]));
let next = 0;

await Promise.all(Array.from({ length: SIDE_BY_SIDE }, worker));
await (await browser()).close();
const total = totalOf(Object.values(rows));
print({ ...rows, all: total });
console.log(inOneLine(total));
if (file) await writeFile(file, JSON.stringify({ rows, total }));
exit(total.lost + total.undecided > 0 ? 1 : 0);

async function worker() {
  while (next < Number(trials)) {
    const index = next++;
    const name = names[index % names.length];
    await trial(name, index, Number(seed), rows[name]);
    if (index % names.length === names.length - 1) console.log(`so far ${inOneLine(totalOf(Object.values(rows)))}`);
  }
}

/** @param {Row} row */
function inOneLine({ trials, lost, undecided }) {
  const unknown = undecided > 0 ? `; ${undecided} did not come to their end, of which nothing is known` : '';
  return `${trials} kills, work lost: ${lost}${unknown}`;
}

/** @param {Record<string, Row>} table */
function print(table) {
  console.log(`${'how it ended'.padEnd(22)} trials  edits  not yet saved  of these back  lost  undecided`);
  for (const [name, { trials, edits, unsaved, broughtBack, lost, undecided }] of Object.entries(table)) {
    const cells = [[trials, 6], [edits, 7], [unsaved, 15], [broughtBack, 15], [lost, 6], [undecided, 11]];
    console.log(name.padEnd(22) + cells.map(([value, width]) => String(value).padStart(width)).join(''));
  }
}
