/** Numbers typed key by key, keys that are held down, and keys in a sheet: as hands are, not as programs. */
import assert from 'node:assert/strict';
import { drawn, pageTest, step, until } from './support/browser.mjs';
import { choose, file } from './support/files.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { demoFile } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('playwright-core').Locator} Locator */

pageTest('hands on the keyboard', async (page, t) => {
  const stage = new Stage(page);
  await panel.openDemonstration(page);
  await choose(page, await demoFile('femur.jts'));
  await panel.waitForWords(page, /as poses of the femur/);

  await step(page, t, 'decimals are typed key by key', () => decimals(page));
  await step(page, t, 'a calibration that is opened from its sheet fills the fields', () => openedFromTheSheet(page));
  await step(page, t, 'arrows in an open sheet leave the model where it is', () => arrowsInASheet(page, stage));
  await step(page, t, 'Y that is held says yes once', () => heldKey(page, stage));
  await step(page, t, 'Esc in a note leaves the note, and no tool', () => noteLeft(page, stage));
});

/** @param {Page} page */
async function openCalibration(page) {
  await page.getByRole('button', { name: /^Calibration:/ }).click();
  return page.getByRole('dialog', { name: 'Calibration', exact: true });
}

/** @param {Locator} field @param {string} text */
async function typeInto(field, text) {
  await field.press('Control+a');
  // The page draws itself between two keys.
  for (const key of text) {
    await field.press(key);
    await drawn(field.page());
  }
  return field.inputValue();
}

/** @param {Page} page */
async function decimals(page) {
  const sheet = await openCalibration(page);
  const fields = sheet.getByRole('spinbutton');
  const typed = ['1198.25', '0.373', '-0.5', '0.05'];
  const shown = [];
  for (const [at, text] of typed.entries()) shown.push(await typeInto(fields.nth(at), text));
  assert.deepEqual(shown, typed);
  await page.keyboard.press('Escape');
}

/** @param {Page} page */
async function openedFromTheSheet(page) {
  const sheet = await openCalibration(page);
  const [chooser] = await Promise.all([page.waitForEvent('filechooser'), sheet.getByRole('button', { name: 'Open a calibration file' }).click()]);
  await chooser.setFiles(file('other.txt', 'JT_INTCALIB\n1000\n0\n0\n0.4\n'));
  const distance = sheet.getByRole('spinbutton').first();
  await until(() => distance.inputValue(), (value) => value === '1000', 'the distance of the file that was opened');
  await page.keyboard.press('Escape');
  await page.keyboard.press('Control+z');
}

/** @param {Page} page @param {Stage} stage */
async function arrowsInASheet(page, stage) {
  await stage.canvas.focus();
  await page.keyboard.press('a');
  const x = page.getByRole('region', { name: 'Pose numbers' }).getByRole('spinbutton', { name: 'x (mm)', exact: true });
  const before = await x.inputValue();
  await page.keyboard.press('?');
  const sheet = page.getByRole('dialog', { name: 'Keys and mouse' });
  await sheet.waitFor();
  // Keys go to the frame until the sheet has the focus.
  await until(() => sheet.evaluate((it) => it.contains(document.activeElement)), (has) => has, 'the focus in the sheet');
  for (let k = 0; k < 3; k++) await page.keyboard.press('ArrowRight');
  await drawn(page);
  assert.equal(await x.inputValue(), before);
  await page.keyboard.press('Escape');
}

/** An even number of presses: each would take back what the one before it said. @param {Page} page @param {Stage} stage */
async function heldKey(page, stage) {
  await stage.canvas.focus();
  for (let k = 0; k < 4; k++) await page.keyboard.down('y');
  await page.keyboard.up('y');
  await page.getByRole('button', { name: 'Checked', exact: true, pressed: true }).waitFor();
}

/** @param {Page} page @param {Stage} stage */
async function noteLeft(page, stage) {
  await stage.canvas.focus();
  await page.keyboard.press('a');
  await page.getByRole('button', { name: 'Refine from here' }).waitFor();
  await page.keyboard.press('Shift+j');
  await page.keyboard.type('rim');
  await page.keyboard.press('Escape');
  await until(() => stage.canvas.evaluate((canvas) => canvas === document.activeElement), (focused) => focused, 'the stage to be in hand');
  await drawn(page);
  assert(await page.getByRole('button', { name: 'Refine from here' }).isVisible());
}
