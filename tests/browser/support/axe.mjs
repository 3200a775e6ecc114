/** The checker of the web's accessibility guidelines, and what it must find: nothing. */
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';

/** @typedef {import('playwright-core').Page} Page */

const AXE = createRequire(import.meta.url).resolve('axe-core/axe.min.js');
/** The rules of version 2.1 of the guidelines, A and AA. */
const RULES = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'];
const CONTROLS = /^(button|radio|checkbox|slider|spinbutton|textbox|combobox|application|img|progressbar|dialog|link|menuitem|tab|switch)$/;

/** Brings the checker into a page, past the page's policy, which lets no script in. @param {Page} page */
export async function bringAxe(page) {
  await page.evaluate(await readFile(AXE, 'utf8'));
}

/** No rule of the guidelines is broken, and every control has a name. @param {Page} page */
export async function isAccessible(page) {
  const violations = await page.evaluate(async (rules) => {
    const { violations } = await globalThis.axe.run(document, { runOnly: rules });
    return violations.map(({ id, impact, help, nodes }) => `${id} (${impact}): ${help}: ${nodes.map((node) => node.html.slice(0, 160)).join(' and ')}`);
  }, RULES);
  assert.deepEqual(violations, []);
  const lines = (await page.locator('body').ariaSnapshot()).split('\n').map((line) => line.trim());
  const nameless = lines.filter((line) => {
    const [, role, rest] = /^- '?([a-z]+)(.*)$/.exec(line) ?? [];
    return role && CONTROLS.test(role) && !rest.startsWith(' "');
  });
  assert.deepEqual(nameless, [], 'controls without a name');
}
