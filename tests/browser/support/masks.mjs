/** Masks on their way into the page and out of it. */
import { mkdir, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { decode, encode } from 'fast-png';
import { unzipSync } from 'fflate';
import { until } from './browser.mjs';
import { dropPaths, file, temporaryFolder } from './files.mjs';
import { demoFile } from './study.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./files.mjs').FileToOpen} FileToOpen */
/** @typedef {{ width: number, height: number, inside: boolean[] }} Mask */

/** @param {'femur' | 'tibia'} component @param {number} frame from 1 */
export function maskFile(component, frame) {
  return demoFile(`masks/${component}/${String(frame).padStart(4, '0')}.png`);
}

/** Drops a folder of the demonstration's masks, as they lie there. @param {Page} page @param {readonly ('femur' | 'tibia')[]} components @param {readonly number[]} frames */
export async function dropMasks(page, components, frames) {
  const files = await Promise.all(
    components.flatMap((component) => frames.map(async (frame) => ({ path: `${component}/${frame}`, ...(await maskFile(component, frame)) }))),
  );
  const named = files.map(({ path, name, buffer }) => /** @type {const} */ ([join(dirname(path), name), buffer]));
  await dropFolder(page, 'masks', named);
}

/** @param {Page} page @param {string} name @param {readonly (readonly [string, Uint8Array])[]} files paths inside the folder */
export async function dropFolder(page, name, files) {
  const folder = join(await temporaryFolder(), name);
  for (const [path, bytes] of files) {
    await mkdir(dirname(join(folder, path)), { recursive: true });
    await writeFile(join(folder, path), bytes);
  }
  await dropPaths(page, [folder]);
}

/** Says yes to what is proposed. @param {Page} page @param {number} count */
export async function importAll(page, count) {
  const sheet = page.getByRole('dialog', { name: 'Import outlines' });
  await sheet.getByRole('button', { name: count === 1 ? 'Import 1 outline' : `Import ${count} outlines`, exact: true }).click();
  await sheet.waitFor({ state: 'hidden' });
}

/** Rows of the sheet: from, to, notes. @param {Page} page */
export async function proposed(page) {
  const rows = page.getByRole('table', { name: 'Where each outline goes' }).getByRole('row');
  await until(() => rows.count(), (count) => count > 1, 'a proposal');
  const texts = await rows.evaluateAll((all) => all.slice(1).map((row) => [...row.children].map((cell) => cell.textContent ?? '')));
  return texts.map(([from, to, notes]) => ({ from, to, notes }));
}

/** A grey PNG of a mask. @param {string} name @param {number} width @param {number} height @param {(column: number, row: number) => number} value */
export function drawnMask(name, width, height, value) {
  const data = Uint8Array.from({ length: width * height }, (_, at) => value(at % width, Math.floor(at / width)));
  return file(name, encode({ width, height, data, depth: 8, channels: 1 }));
}

/** @param {Uint8Array} png @returns {Mask} */
export function maskOf(png) {
  const { width, height, data } = decode(png);
  return { width, height, inside: Array.from(data, (value) => value > 0) };
}

/** Pixels that two masks have otherwise. @param {Mask} a @param {Mask} b */
export function differing(a, b) {
  return a.inside.filter((inside, at) => inside !== b.inside[at]).length;
}

/** The files of a zip by their paths. @param {FileToOpen} zip */
export function unzipped({ buffer }) {
  return unzipSync(new Uint8Array(buffer));
}
