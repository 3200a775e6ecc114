/** Nothing leaves the page: its policy is in force, and a whole day's work neither breaks it nor asks another computer. */
import assert from 'node:assert/strict';
import { ADDRESS, drawn, pageTest, step } from './support/browser.mjs';
import { exported } from './support/exporting.mjs';
import { temporaryFolder } from './support/files.mjs';
import { Host } from './support/host.mjs';
import * as panel from './support/panel.mjs';
import { fromOpeningToPose } from './support/workflow.mjs';

/** @typedef {import('playwright-core').Page} Page */

/** Directives that must be there, and must be this narrow. */
const NARROW = ["default-src 'none'", "script-src 'self' 'wasm-unsafe-eval'", "style-src 'self'", "connect-src 'self'", "worker-src 'self'", "base-uri 'none'", "form-action 'none'"];

pageTest('the policy is strict', async (page, t) => {
  await step(page, t, 'header and page say it', async () => {
    const response = await page.reload();
    const header = (await response?.headerValue('content-security-policy')) ?? '';
    const meta = (await page.locator('meta[http-equiv=Content-Security-Policy]').getAttribute('content')) ?? '';
    for (const policy of [header, meta]) {
      const directives = policy.split('; ');
      for (const directive of NARROW) assert(directives.includes(directive), `"${directive}" is not in "${policy}"`);
      assert.doesNotMatch(policy, /unsafe-inline|unsafe-eval'(?<!wasm-unsafe-eval')|\*|https?:/);
    }
    assert.match(header, /frame-ancestors 'none'/);
  });
});

pageTest('a whole workflow breaks no rule and asks nobody', async (page, t) => {
  /** @type {string[]} */
  const asked = [];
  page.context().on('request', (request) => asked.push(request.url()));
  await page.addInitScript(recordViolations);
  await page.reload();

  await step(page, t, 'from the demonstration to a pose', () => fromOpeningToPose(page));
  await step(page, t, 'every sheet', () => openSheets(page));
  await step(page, t, 'what is saved is saved here', async () => {
    await exported(page, 'Session');
    await exported(page, 'Poses', 'JTS', 'Femur');
  });
  await step(page, t, 'nothing was asked of others, nothing was refused', async () => {
    const others = asked.filter((url) => !url.startsWith(ADDRESS) && !/^(blob|data):/.test(url));
    assert.deepEqual(others, []);
    // The recording sees what the page and its workers fetch.
    for (const name of ['demo/frames/0001.png', 'fluoropose_page_bg', 'fluoropose_wasm_bg', 'fluoropose_decode_bg', 'pose-', 'library-', 'decode-']) {
      assert(asked.some((url) => url.includes(name)), `no request for ${name} was recorded`);
    }
    assert.deepEqual(await violations(page), []);
  });
}, { builds: true });

pageTest('what the policy forbids is refused', async (page, t) => {
  const other = await new Host(await temporaryFolder(), '/').start();
  await page.addInitScript(recordViolations);
  await page.reload();
  await drawn(page);
  for (const [what, directive, attempt] of ATTEMPTS) {
    await step(page, t, what, async () => {
      await page.evaluate(() => (globalThis.violations = []));
      await page.evaluate(attempt, other.address).catch(() => undefined);
      await page.waitForFunction((name) => globalThis.violations.some((violation) => violation.startsWith(name)), directive);
    });
  }
  assert.deepEqual(other.asked, [], 'the other host was never reached');
}, { refusals: true });

/** @type {[what: string, directive: string, attempt: (address: string) => unknown][]} */
const ATTEMPTS = [
  ['asking another host', 'connect-src', (address) => fetch(address)],
  ['sending to another host', 'connect-src', (address) => navigator.sendBeacon(address, 'pixels')],
  ['a picture of another host', 'img-src', (address) => Object.assign(new Image(), { src: `${address}pixels.png` }).decode()],
  ['a script of another host', 'script-src', (address) => document.head.append(Object.assign(document.createElement('script'), { src: `${address}script.js` }))],
  ['a script written into the page', 'script-src', () => document.head.append(Object.assign(document.createElement('script'), { textContent: 'globalThis.broken = true' }))],
  // In a timer: what a debugger evaluates itself may run text.
  ['text run as code', 'script-src', () => void setTimeout(() => (0, eval)('1'))],
  ['a style written into the page', 'style-src', () => document.head.append(Object.assign(document.createElement('style'), { textContent: 'body { color: red }' }))],
];

/** Runs in the page before anything else. */
function recordViolations() {
  globalThis.violations = [];
  document.addEventListener('securitypolicyviolation', ({ effectiveDirective, blockedURI }) => {
    globalThis.violations.push(`${effectiveDirective} ${blockedURI}`);
  });
}

/** @param {Page} page @returns {Promise<string[]>} */
function violations(page) {
  return page.evaluate(() => globalThis.violations);
}

/** Opens and closes everything that opens over the page. @param {Page} page */
async function openSheets(page) {
  const openers = page.locator('button[aria-haspopup=dialog]:enabled');
  const count = await openers.count();
  assert(count >= 6, `only ${count} buttons open a sheet`);
  for (let index = 0; index < count; index++) {
    await openers.nth(index).click();
    await page.getByRole('dialog').first().waitFor();
    await drawn(page);
    await page.keyboard.press('Escape');
    await page.getByRole('dialog').first().waitFor({ state: 'hidden' });
  }
  assert(await panel.shownPose(page), 'the pose is still there');
}
