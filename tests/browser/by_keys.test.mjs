/** The whole work by the keyboard alone: from opening by way of first poses and the film to what is published. */
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { atRest, pageTest, screenshot, step, until } from './support/browser.mjs';
import { exportSheet } from './support/exporting.mjs';
import { hasFocus, tabTo } from './support/focus.mjs';
import * as panel from './support/panel.mjs';
import { trueOutline } from './support/study.mjs';
import * as tracing from './support/tracing.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./support/study.mjs').Point} Point */

/** Of the demonstration: how far it is followed is not what is tested. */
const FRAMES = 2;
/** Frame pixels of an arrow with Shift; alone it is one. */
const COARSE = 10;

pageTest('by the keyboard alone', async (page, t) => {
  await step(page, t, 'opens, with the focus on the frame', async () => {
    await panel.shorten(page, FRAMES);
    await tabTo(page, 'Open the demonstration');
    await page.keyboard.press('Enter');
    await panel.waitForFrames(page, FRAMES);
    await panel.waitForLibraries(page, 'Femur', 'Tibia');
    await hasFocus(page, new RegExp(`frame 1 of ${FRAMES}`));
  });
  await step(page, t, 'points at both components', async () => {
    let at = /** @type {Point} */ ([512, 512]);
    for (const component of /** @type {const} */ (['femur', 'tibia'])) {
      const to = tracing.insideOf(await trueOutline(component, 1));
      await moved(page, at, to);
      await screenshot(page, `pointed at the ${component} by keys`);
      await page.keyboard.press('Enter');
      at = to;
    }
    const card = page.getByRole('region', { name: 'What to do next' });
    await card.getByRole('button', { name: 'Follow the film' }).waitFor();
    await atRest(page);
  });
  await step(page, t, 'follows the film', async () => {
    await page.keyboard.press('Shift+G');
    const isDone = (/** @type {string} */ cell) => /: followed(,|$)/.test(cell);
    await until(() => panel.cells(page), (cells) => cells.filter(isDone).length === 2 * (FRAMES - 1), 'the film to be followed');
    await atRest(page);
    await hasFocus(page, new RegExp(`frame 1 of ${FRAMES}`));
  });
  await step(page, t, 'looks at the joint', async () => {
    await page.keyboard.press('Shift+K');
    await page.getByRole('img', { name: new RegExp(`^Lift-off over frame in ${FRAMES} frames`) }).waitFor();
    // A slider has its name, too.
    for (let k = 0; k < 2 && !(await page.locator('[role="radio"]:focus').count()); k++) await tabTo(page, 'Frame');
    await page.keyboard.press('End');
    await page.getByRole('img', { name: new RegExp(`^Lift-off over flexion in ${FRAMES} frames`) }).waitFor();
    await hasFocus(page, 'Flexion');
  });
  await step(page, t, 'saves table, figure and film, and is back where it was', async () => {
    await tabTo(page, 'Export…');
    await page.keyboard.press('Enter');
    await page.getByRole('region', { name: 'Preview' }).waitFor();
    const table = await saved(page);
    assert.match(table.toString(), /^# fluoropose [^\n]* joint table/);
    await chosen(page, 'Joint numbers', 1, 'Figure');
    assert.match((await saved(page)).toString(), /^<svg/);
    await chosen(page, 'Figure', 2, 'Overlay film');
    assert((await saved(page, 'Control+Enter')).length > 20_000);
    await screenshot(page, 'by the keyboard');
    await page.keyboard.press('Escape');
    await hasFocus(page, 'Export…');
  });
});

/** Rows first: left and right change frames until another arrow has taken the pointer. @param {Page} page @param {Point} from @param {Point} to */
async function moved(page, from, to) {
  for (const [axis, less, more] of /** @type {const} */ ([[1, 'ArrowUp', 'ArrowDown'], [0, 'ArrowLeft', 'ArrowRight']])) {
    const away = Math.round(to[axis]) - Math.round(from[axis]);
    const key = away < 0 ? less : more;
    for (let k = 0; k < Math.trunc(Math.abs(away) / COARSE); k++) await page.keyboard.press(`Shift+${key}`);
    for (let k = 0; k < Math.abs(away) % COARSE; k++) await page.keyboard.press(key);
  }
}

/** From one choice of the sheet to the one `steps` further, by arrows. @param {Page} page @param {string} from @param {number} steps @param {string} to */
async function chosen(page, from, steps, to) {
  await tabTo(page, from, 'Shift+Tab');
  for (let k = 0; k < steps; k++) await page.keyboard.press('ArrowDown');
  await hasFocus(page, to);
  await page.getByRole('radio', { name: to, exact: true, checked: true }).waitFor();
}

/** By the button, or from wherever the focus is. @param {Page} page @param {'Enter' | 'Control+Enter'} key */
async function saved(page, key = 'Enter') {
  if (key === 'Enter') await tabTo(page, /^Save \S+\.\w+$/);
  await exportSheet(page).getByRole('button', { name: /^Save \S+\.\w+$/, disabled: false }).waitFor();
  const coming = page.waitForEvent('download');
  await page.keyboard.press(key);
  return readFile(await (await coming).path());
}
