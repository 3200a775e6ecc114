/** The sheet that writes files. */
import { readFile } from 'node:fs/promises';
import { IN_FIREFOX } from './browser.mjs';
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
  const save = exportSheet(page).getByRole('button', { name: /^Save \S+$/ });
  if (IN_FIREFOX) return savedInFirefox(page, save);
  const coming = page.waitForEvent('download');
  await save.click();
  const download = await coming;
  return file(download.suggestedFilename(), await readFile(await download.path()));
}

/** Its driver has no word for downloads: what the page gives an address to is the file. @param {Page} page @param {import('playwright-core').Locator} save */
async function savedInFirefox(page, save) {
  await page.evaluate(() => {
    const own = URL.createObjectURL;
    const saved = new Promise((resolve) => {
      URL.createObjectURL = (blob) => {
        URL.createObjectURL = own;
        resolve(blob);
        return own.call(URL, blob);
      };
    });
    Object.assign(window, { saved });
  });
  await save.click();
  const text = await page.evaluate(async () => (await (/** @type {any} */ (window).saved)).text());
  return file('saved', text);
}

/** A file by way of the sheet, which is closed again. @param {Page} page @param {string} kind @param {...string} choices form, component */
export async function exported(page, kind, ...choices) {
  await openExport(page, kind, ...choices);
  const saved = await savedFile(page);
  const sheet = exportSheet(page);
  await sheet.press('Escape');
  await sheet.waitFor({ state: 'detached' });
  return saved;
}
