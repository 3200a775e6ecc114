/** What a page loads, compressed as a host would send it. */
import { gzipSync } from 'node:zlib';
import * as panel from './panel.mjs';
import { visit } from './browser.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {{ path: string, bytes: number }} Loaded path and size, compressed where that helps */

/** Every file that comes until the page is usable. @param {Page} page @returns {Promise<Loaded[]>} */
export function firstLoadOf(page) {
  return loadedDuring(page, () => visit(page));
}

/**
 * The same and what comes on top until libraries are built and poses can be found, without the frames themselves and the
 * decoders that read them.
 *
 * @param {Page} page
 * @param {Loaded[]} before
 */
export async function pathOfTracing(page, before) {
  const later = await loadedDuring(page, async () => {
    await panel.openDemonstration(page);
    await panel.waitForLibraries(page, 'Femur', 'Tibia');
  });
  const known = new Set(before.map(({ path }) => path));
  return [...before, ...later.filter(({ path }) => !known.has(path) && !isOfFrames(path))];
}

/** @param {string} path */
export function isOfFrames(path) {
  return path.startsWith('demo/') || path.includes('decode');
}

/** @param {Loaded[]} files */
export function total(files) {
  return files.reduce((sum, { bytes }) => sum + bytes, 0);
}

/** @param {Page} page @param {() => Promise<void>} work @returns {Promise<Loaded[]>} */
async function loadedDuring(page, work) {
  /** @type {Map<string, Promise<Loaded>>} */
  const files = new Map();
  const note = (/** @type {import('playwright-core').Response} */ response) => {
    const { pathname } = new URL(response.url());
    const path = pathname.slice(1);
    if (response.url().startsWith('http') && !files.has(path)) files.set(path, sizeOf(path, response));
  };
  page.on('response', note);
  await work();
  page.off('response', note);
  return Promise.all(files.values());
}

/** @param {string} path @param {import('playwright-core').Response} response @returns {Promise<Loaded>} */
async function sizeOf(path, response) {
  // The page's own copy may be gone by now: the host has it still.
  const body = Buffer.from(await (await fetch(response.url())).arrayBuffer());
  return { path, bytes: Math.min(body.length, gzipSync(body, { level: 9 }).length) };
}
