/** How soon the demonstration's libraries are there, from its button on: two libraries of 1271 views. */
import { ADDRESS, visit } from '../support/browser.mjs';
import * as panel from '../support/panel.mjs';

/** @typedef {import('playwright-core').Page} Page */

const STARTS = 5;

/** @param {Page} page @returns {Promise<import('./main.mjs').Row[]>} */
export async function libraries(page) {
  const times = { first: [], both: [] };
  for (let start = 0; start < STARTS; start++) {
    await page.goto(ADDRESS);
    await visit(page);
    const from = performance.now();
    await panel.openDemonstration(page);
    await panel.waitForLibraries(page, 'Femur');
    times.first.push(performance.now() - from);
    await panel.waitForLibraries(page, 'Tibia');
    times.both.push(performance.now() - from);
  }
  return Object.entries(times).map(([which, values]) => ({ work: which, value: values.sort((a, b) => a - b)[2] / 1000, unit: 's' }));
}
