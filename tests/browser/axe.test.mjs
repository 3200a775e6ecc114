/** Nothing that the accessibility guidelines forbid: empty, with the demonstration, with each sheet and each tool, dark and light. */
import assert from 'node:assert/strict';
import { bringAxe, isAccessible } from './support/axe.mjs';
import { drawn, pageTest, screenshot, step } from './support/browser.mjs';
import { fromOpeningToPose } from './support/workflow.mjs';

/** @typedef {import('playwright-core').Page} Page */

/** Some of the sheets that are there. */
const SHEETS = ['Calibration', 'Femur', 'Save and export', 'Keys and mouse', 'Log'];
const THEMES = /** @type {const} */ (['dark', 'light']);

pageTest('accessibility in both themes', async (page, t) => {
  await bringAxe(page);
  await step(page, t, 'the empty page', () => inBothThemes(page, 'empty'));
  await step(page, t, 'with the demonstration and a pose', async () => {
    await fromOpeningToPose(page);
    await inBothThemes(page, 'posed');
  });
  await step(page, t, 'with each tool in hand', () => eachTool(page));
  await step(page, t, 'with each sheet open', () => eachSheet(page));
});

/** @param {Page} page @param {string} what is on view */
async function inBothThemes(page, what) {
  for (const theme of THEMES) {
    await choose(page, theme);
    await screenshot(page, `${theme} ${what}`);
    await isAccessible(page);
  }
}

/** By key, as a person would; it works whatever has the focus. @param {Page} page @param {'dark' | 'light'} theme */
async function choose(page, theme) {
  const button = page.getByRole('button', { name: 'Light page', exact: true });
  if (((await button.getAttribute('aria-pressed')) === 'true') !== (theme === 'light')) await page.keyboard.press('Shift+L');
  await page.locator(`html[data-theme=${theme}]`).waitFor();
  await drawn(page);
}

/** Tools differ in their strip alone, which has the colours of the rest: the dark theme will do. @param {Page} page */
async function eachTool(page) {
  await choose(page, 'dark');
  const tools = page.getByRole('navigation', { name: 'Tools' }).locator('button[aria-pressed]');
  const count = await tools.count();
  assert(count >= 4, `only ${count} tools`);
  for (let index = 0; index < count; index++) {
    await tools.nth(index).click();
    await drawn(page);
    await isAccessible(page);
  }
}

/** @param {Page} page */
async function eachSheet(page) {
  const openers = page.locator('button[aria-haspopup=dialog]:enabled');
  const count = await openers.count();
  assert(count >= 6, `only ${count} buttons open a sheet`);
  const seen = [];
  for (let index = 0; index < count; index++) {
    await openers.nth(index).click();
    const name = await page.getByRole('dialog').first().getAttribute('aria-label');
    seen.push(name);
    await inBothThemes(page, `sheet ${name}`);
    await page.keyboard.press('Escape');
    await page.getByRole('dialog').first().waitFor({ state: 'hidden' });
  }
  for (const sheet of SHEETS) assert(seen.includes(sheet), `${sheet} is not among ${seen.join(', ')}`);
}
