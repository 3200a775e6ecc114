/** How fast the core is in a worker of Chromium. */
import { cp, mkdir, symlink, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { openWindow, setting } from '../support/browser.mjs';
import { temporaryFolder } from '../support/files.mjs';
import { Host } from '../support/host.mjs';
import { demoFile, polygonWithin, trueOutline } from '../support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {{ library: number, best: number[], masks: number[], polygons: number[], live: number[] }} Times milliseconds */

const WORKER = fileURLToPath(new URL('speed_worker.mjs', import.meta.url));
const FRAMES = 8;

/** @returns {Promise<import('./main.mjs').Row[]>} */
export async function speed() {
  const folder = await temporaryFolder();
  await symlink(join(setting('FLUOROPOSE_PACKAGE'), 'npm'), join(folder, 'npm'), 'junction');
  await cp(WORKER, join(folder, 'worker.mjs'));
  await mkdir(join(folder, 'demo'));
  for (const name of ['femur.stl', 'calibration.txt']) await writeFile(join(folder, 'demo', name), (await demoFile(name)).buffer);
  await writeFile(join(folder, 'index.html'), '<!doctype html><title>Speed</title>');
  const host = await new Host(folder, '/').start();
  const ofAll = (outlined) => Promise.all(Array.from({ length: FRAMES }, (_, frame) => outlined('femur', frame + 1)));
  const masks = await ofAll((part, frame) => polygonWithin(part, frame, 0));
  const polygons = await ofAll(trueOutline);
  const page = await openWindow();
  try {
    await page.goto(host.address);
    return rowsOf(await page.evaluate(driven, { masks, polygons }));
  } finally {
    await page.context().close();
    await host.stop();
  }
}

/** Runs in the page. @param {{ masks: unknown, polygons: unknown }} task @returns {Promise<Times>} */
function driven(task) {
  const worker = new Worker('/worker.mjs', { type: 'module' });
  return new Promise((resolve, reject) => {
    worker.onmessage = ({ data }) => {
      worker.terminate();
      if (data.failed) reject(new Error(data.failed));
      else resolve(data);
    };
    worker.onerror = (event) => reject(new Error(event.message));
    worker.postMessage(task);
  });
}

/** @param {Times} times @returns {import('./main.mjs').Row[]} */
function rowsOf({ library, best, masks, polygons, live }) {
  return [
    { work: 'exact best of 1271 views in a worker, median', value: quantile(best, 0.5), unit: 'ms' },
    { work: 'library of 1271 views in one worker', value: library / 1000, unit: 's' },
    { work: 'mask to refined poses with mirror candidates, median', value: quantile(masks, 0.5), unit: 'ms' },
    { work: 'polygon of some 45 points to the same, median', value: quantile(polygons, 0.5), unit: 'ms' },
    { work: 'live pose while a point moves, followed and refined, p95', value: quantile(live, 0.95), unit: 'ms' },
  ];
}

/** @param {number[]} values @param {number} part */
export function quantile(values, part) {
  const sorted = values.toSorted((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))] ?? NaN;
}
