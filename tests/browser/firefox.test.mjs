/** The whole way in Firefox: demonstration, outline by mouse, refined pose, keys, sheets. Runs as well in Chromium. */
import assert from 'node:assert/strict';
import { IN_FIREFOX, pageTest, screenshot, step } from './support/browser.mjs';
import * as panel from './support/panel.mjs';
import { fromOpeningToPose, traceFemur } from './support/workflow.mjs';

/** @typedef {import('playwright-core').Page} Page */

pageTest(`from opening to a pose in ${IN_FIREFOX ? 'Firefox' : 'Chromium'}`, async (page, t) => {
  await step(page, t, 'it is the browser it should be', async () => {
    assert.equal(/Firefox/.test(await page.evaluate(() => navigator.userAgent)), IN_FIREFOX);
  });

  /** @type {import('./support/study.mjs').Pose} */
  let refined;
  await step(page, t, 'an outline clicked around the femur gives its known pose, refined', async () => {
    ({ pose: refined } = await fromOpeningToPose(page));
    const { x } = await panel.deviations(page);
    assert(x > 0, 'a refined pose has its deviations');
    await screenshot(page, 'posed');
  });

  await step(page, t, 'undo by key takes the outline back, redo brings it and its pose again', async () => {
    await page.keyboard.press('Control+z');
    await page.keyboard.press('Control+y');
    await panel.waitForThePose(page, refined);
  });

  await step(page, t, 'frames by key', async () => {
    await page.keyboard.press('f');
    await page.getByRole('application', { name: /frame 2 of 8/ }).waitFor();
    await page.keyboard.press('d');
    await page.getByRole('application', { name: /frame 1 of 8/ }).waitFor();
  });

  await step(page, t, 'the sheet of keys', async () => {
    await page.keyboard.press('?');
    await page.getByRole('dialog', { name: 'Keys and mouse' }).waitFor();
    await page.keyboard.press('Escape');
    await page.getByRole('dialog').waitFor({ state: 'hidden' });
  });

  await step(page, t, 'the whole outline goes by key and can be traced again', async () => {
    await page.keyboard.press('Shift+Delete');
    await page.keyboard.press('0');
    await traceFemur(page);
  });
}, { builds: true });
