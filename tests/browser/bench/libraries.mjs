/** How soon two libraries of all directions are there, from the demonstration's frames on. */
import { visit } from '../support/browser.mjs';
import * as panel from '../support/panel.mjs';
import { quantile } from './speed.mjs';

/** @typedef {import('playwright-core').Page} Page */

const STARTS = 5;

/** @param {Page} page @returns {Promise<import('./main.mjs').Row[]>} */
export async function libraries(page) {
  const times = { first: [], both: [] };
  for (let start = 0; start < STARTS; start++) {
    if (start > 0) await visit(page);
    await panel.openDemonstration(page);
    const from = performance.now();
    const there = ['Femur', 'Tibia'].map(async (component) => {
      await panel.waitForLibrary(page, component);
      return (performance.now() - from) / 1000;
    });
    times.first.push(await Promise.race(there));
    times.both.push(Math.max(...(await Promise.all(there))));
  }
  return [
    { work: 'demonstration: the first library is there, median of 5', value: quantile(times.first, 0.5), unit: 's' },
    { work: 'both of them', value: quantile(times.both, 0.5), unit: 's' },
  ];
}
