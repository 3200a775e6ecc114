/** Measures the page and writes the figures to a file: `cargo xtask bench --browser` starts it. */
import { writeFile } from 'node:fs/promises';
import { argv } from 'node:process';
import { browser, openWindow, visit } from '../support/browser.mjs';
import { following } from './following.mjs';
import { dragging, wiring } from './interaction.mjs';
import { libraries } from './libraries.mjs';
import { long } from './long_film.mjs';
import { firstLoad, warmStart } from './loading.mjs';
import { newUser } from './new_user.mjs';
import { speed } from './speed.mjs';

/** @typedef {{ work: string, value: number, unit: string }} Row */

const [, , file] = argv;
if (!file) throw new Error('the file to write is not named: run `cargo xtask bench --browser`');

/** @type {Row[]} */
const rows = [];
for (const measurement of [firstLoad, warmStart, libraries, newUser, dragging, wiring, following, long]) rows.push(...(await measured(measurement)));
rows.push(...(await speed()));
await writeFile(file, JSON.stringify({ rows: rows.map(rounded) }));
await (await browser()).close();

/** In a window of its own. @param {(page: import('playwright-core').Page) => Promise<Row[]>} measurement */
async function measured(measurement) {
  const page = await openWindow({ serviceWorkers: measurement === warmStart ? 'allow' : 'block' });
  try {
    await visit(page);
    return await measurement(page);
  } finally {
    await page.context().close();
  }
}

/** To what means something. @param {Row} row */
function rounded({ work, value, unit }) {
  const whole = unit !== 'ms' && unit !== 's' && unit !== 'a second';
  return { work, value: whole ? Math.round(value) : Number(value.toPrecision(3)), unit };
}
