/** What the first load brings, and how soon the page is usable when it is kept. */
import { firstLoadOf, pathOfTracing, total } from '../support/loading.mjs';
import { ADDRESS } from '../support/browser.mjs';

/** @typedef {import('playwright-core').Page} Page */

const STARTS = 9;

/** @param {Page} page @returns {Promise<import('./main.mjs').Row[]>} */
export async function firstLoad(page) {
  const empty = await firstLoadOf(page);
  const tracing = await pathOfTracing(page, empty);
  return [
    { work: 'first load until outlines can be traced, compressed (gzip)', value: total(empty), unit: 'bytes' },
    { work: 'the same with the workers that build libraries and find poses, compressed (gzip)', value: total(tracing), unit: 'bytes' },
  ];
}

/** From the beginning of the navigation to the first frame with the page on it. @param {Page} page @returns {Promise<import('./main.mjs').Row[]>} */
export async function warmStart(page) {
  await page.evaluate(() => navigator.serviceWorker.ready.then(() => undefined));
  await page.addInitScript(noteWhenUsable);
  const times = [];
  for (let start = 0; start < STARTS; start++) {
    await page.goto(ADDRESS);
    times.push(await page.waitForFunction(() => globalThis.usableAt).then((handle) => handle.jsonValue()));
  }
  times.sort((a, b) => a - b);
  return [
    { work: 'usable from a warm cache, median of 9', value: times[(STARTS - 1) / 2] / 1000, unit: 's' },
    { work: 'usable from a warm cache, slowest of 9', value: times[STARTS - 1] / 1000, unit: 's' },
  ];
}

/** Runs in the page before anything else: notes when its first button has been drawn, ms after the navigation began. */
function noteWhenUsable() {
  const look = () => {
    if (document.querySelector('main button')) requestAnimationFrame(() => setTimeout(() => (globalThis.usableAt = performance.now())));
    else requestAnimationFrame(look);
  };
  look();
}
