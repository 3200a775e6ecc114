/** Tools and the keyboard: drafts survive a change of tool, and a region needs no mouse. */
import assert from 'node:assert/strict';
import { pageTest, screenshot, step } from './support/browser.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { truePose } from './support/study.mjs';
import * as tracing from './support/tracing.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./support/study.mjs').Point} Point */

pageTest('tools and the keyboard', async (page, t) => {
  const stage = new Stage(page);
  await tracing.openDemonstration(page);
  await stage.learn();
  await step(page, t, 'switching tools keeps a draft, Esc leaves without loss', () => draftStays(page, stage));
  await step(page, t, 'the keyboard alone takes a region', (t) => byKeyboard(page, t));
  await step(page, t, 'the sheet of keys tells of all of them', () => sheetOfKeys(page));
});

/** @param {Page} page @param {Stage} stage */
async function draftStays(page, stage) {
  await page.keyboard.press('p');
  for (const point of /** @type {Point[]} */ ([[400, 400], [600, 400], [600, 600]])) await stage.click(point);
  await panel.waitForWords(page, /^3 points\./);
  for (const key of ['l', 't', 'b', 'k', 'm', 'o', 'v', 'Escape', 'p']) await page.keyboard.press(key);
  await stage.hover([700, 300]);
  await panel.waitForWords(page, /^3 points\./);
  await page.keyboard.press('l');
  await stage.click([500, 700]);
  await page.getByRole('button', { name: 'Undo: follow the edge' }).waitFor();
  await page.keyboard.press('Control+z');
  await page.keyboard.press('p');
  await stage.hover([700, 300]);
  await panel.waitForWords(page, /^3 points\./);
  await page.keyboard.press('Shift+Delete');
}

/** @param {Page} page @param {import('node:test').TestContext} t */
async function byKeyboard(page, t) {
  await page.getByRole('application').focus();
  await page.mouse.move(1, 1);
  await page.keyboard.press('t');
  // From the middle of the frame, at 512 and 512, into the femur's shield.
  await page.keyboard.press('Shift+ArrowDown');
  await page.keyboard.press('Shift+ArrowDown');
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('i');
  const pose = await tracing.corrected(page);
  t.diagnostic(`by keyboard: ${panel.differences(pose, await truePose('femur', 1))}`);
  panel.assertNear(pose, await truePose('femur', 1), tracing.BY_ONE_CLICK);
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('Enter');
  await tracing.toolInHand(page, 'Edit points');
}

/** @param {Page} page */
async function sheetOfKeys(page) {
  await page.keyboard.press('?');
  const sheet = page.getByRole('dialog', { name: 'Keys and mouse' });
  // What it tells comes when it is first opened.
  await sheet.getByText('Live-wire').first().waitFor();
  const text = await sheet.innerText();
  for (const words of ['Live-wire', 'Threshold', 'One click', 'Brush', 'Snap the outline', 'Copy the outline of the previous frame']) {
    assert(text.includes(words), `the sheet says nothing of ${words}`);
  }
  await screenshot(page, 'keys of tools');
  await page.keyboard.press('Escape');
}
