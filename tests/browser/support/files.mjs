/** Files on their way into the page and out of it. */
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after } from 'node:test';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {{ name: string, mimeType: string, buffer: Buffer }} FileToOpen */

/** @param {string} name @param {Uint8Array | string} content @returns {FileToOpen} */
export function file(name, content) {
  return { name, mimeType: 'application/octet-stream', buffer: Buffer.from(content) };
}

/** Opens files with the button of the page and the browser's file chooser. @param {Page} page @param {...FileToOpen} files */
export async function choose(page, ...files) {
  const chooser = page.waitForEvent('filechooser');
  await page.getByRole('button', { name: 'Open files' }).first().click();
  await (await chooser).setFiles(files);
}

/** @type {string[]} */
const folders = [];
// A browser that was closed may write its profile for a moment more.
after(() => Promise.all(folders.map((folder) => rm(folder, { recursive: true, maxRetries: 20, retryDelay: 250 }))));

/** A new empty folder, deleted when the tests of this process end. */
export async function temporaryFolder() {
  const folder = await mkdtemp(join(tmpdir(), 'fluoropose-'));
  folders.push(folder);
  return folder;
}

/** Drops files on the frame, as the system's file manager would. @param {Page} page @param {...FileToOpen} files */
export async function drop(page, ...files) {
  const folder = await temporaryFolder();
  const paths = files.map(({ name }) => join(folder, name));
  await Promise.all(files.map(({ buffer }, index) => writeFile(paths[index], buffer)));
  await dropPaths(page, paths);
}

/** Drops files or folders of the disk. @param {Page} page @param {string[]} paths */
export async function dropPaths(page, paths) {
  const browser = await page.context().newCDPSession(page);
  const data = { items: [], files: paths, dragOperationsMask: 1 };
  for (const type of /** @type {const} */ (['dragEnter', 'dragOver', 'drop'])) {
    await browser.send('Input.dispatchDragEvent', { type, x: 600, y: 400, data });
  }
  await browser.detach();
}

/** Clicks and waits for the file that the page offers. @param {Page} page @param {string | RegExp} button */
export async function downloaded(page, button) {
  const coming = page.waitForEvent('download');
  await page.getByRole('button', { name: button }).click();
  const download = await coming;
  return file(download.suggestedFilename(), await readFile(await download.path()));
}
