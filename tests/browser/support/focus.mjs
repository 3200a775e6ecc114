/** What has the keyboard's focus, and the way to it. */

import { until } from './browser.mjs';

/** @typedef {import('playwright-core').Page} Page */

/** More presses than this are no way that somebody goes. */
const MOST = 60;

/** The name of what has the focus. @param {Page} page @returns {Promise<string>} */
export function focused(page) {
  return page.evaluate(() => {
    const element = document.activeElement;
    return element?.getAttribute('aria-label') ?? element?.textContent?.replace(/\s+/g, ' ').trim() ?? '';
  });
}

/** Waits until something has the focus. @param {Page} page @param {string | RegExp} name */
export async function hasFocus(page, name) {
  await until(() => focused(page), (here) => isNamed(here, name), `${name} to have the focus`);
}

/** Presses Tab until something has the focus; says how often. @param {Page} page @param {string | RegExp} name @param {'Tab' | 'Shift+Tab'} [key] */
export async function tabTo(page, name, key = 'Tab') {
  const passed = [];
  while (passed.length < MOST) {
    await page.keyboard.press(key);
    const here = await focused(page);
    passed.push(here);
    if (isNamed(here, name)) return passed.length;
  }
  throw new Error(`${name} is not reached: ${passed.join(' | ')}`);
}

/** @param {string} here @param {string | RegExp} name */
function isNamed(here, name) {
  return typeof name === 'string' ? here === name : name.test(here);
}
