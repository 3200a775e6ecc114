/** The sheet that writes files. */
import { readFile } from 'node:fs/promises';
import { file } from './files.mjs';

/** @typedef {import('playwright-core').Page} Page */

/** @param {Page} page */
export function exportSheet(page) {
  return page.getByRole('dialog', { name: 'Save and export' });
}

/** The sheet with what is to be saved, in the form that is wanted. @param {Page} page @param {string} kind @param {...string} choices form, component */
export async function openExport(page, kind, ...choices) {
  const sheet = exportSheet(page);
  if ((await sheet.count()) === 0) await page.getByRole('button', { name: 'Save and export', exact: true }).click();
  for (const name of [kind, ...choices]) await sheet.getByRole('radio', { name, exact: true }).click();
  return sheet;
}

/** Presses the sheet's button and waits for the file. @param {Page} page */
export async function savedFile(page) {
  const coming = page.waitForEvent('download');
  await exportSheet(page).getByRole('button', { name: /^Save \S+$/ }).click();
  const download = await coming;
  return file(download.suggestedFilename(), await readFile(await download.path()));
}

/** A file by way of the sheet, which is closed again. @param {Page} page @param {string} kind @param {...string} choices form, component */
export async function exported(page, kind, ...choices) {
  await openExport(page, kind, ...choices);
  const saved = await savedFile(page);
  const sheet = exportSheet(page);
  // Who saved the session is done.
  if (kind !== 'Session') await sheet.press('Escape');
  await sheet.waitFor({ state: 'detached' });
  return saved;
}

/** Lets each picture of a film wait before a worker gets it; `atOnce` of the window sends them as before. @param {Page} page @param {number} ms */
export async function slowPictures(page, ms) {
  await page.evaluate((ms) => {
    const own = Worker.prototype.postMessage;
    const slow = /** @this {Worker} @param {any} message @param {any} transfer */ function (message, transfer) {
      if (message?.method === 'add') setTimeout(() => own.call(this, message, transfer), ms);
      else own.call(this, message, transfer);
    };
    Worker.prototype.postMessage = slow;
    Object.assign(window, { atOnce: () => (Worker.prototype.postMessage = own) });
  }, ms);
}
