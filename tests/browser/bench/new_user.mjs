/** From opening the page to a refined femoral pose: clicks and seconds, with the best tool and by plain polygon. */
import { byOneClick, byPolygon, countClicks, openDemonstration } from '../support/tracing.mjs';
import { visit } from '../support/browser.mjs';

/** @typedef {import('playwright-core').Page} Page */

/** @param {Page} page @returns {Promise<import('./main.mjs').Row[]>} */
export async function newUser(page) {
  const rows = [];
  for (const [name, way] of /** @type {const} */ ([['one click', byOneClick], ['plain polygon', byPolygon]])) {
    const startedAt = Date.now();
    // What was kept of the way before would be offered again.
    await page.evaluate(forget);
    await visit(page);
    const clicks = await countClicks(page);
    await openDemonstration(page);
    await way(page);
    const seconds = (Date.now() - startedAt) / 1000;
    rows.push({ work: `from opening to a refined femoral pose by ${name}`, value: await clicks(), unit: 'clicks' });
    rows.push({ work: `from opening to a refined femoral pose by ${name}`, value: seconds, unit: 's' });
  }
  return rows;
}

async function forget() {
  for (const { name } of await indexedDB.databases()) if (name) indexedDB.deleteDatabase(name);
}
