/** Without a network after the first load, from a sub-folder of a host without headers; newer versions wait. */
import assert from 'node:assert/strict';
import { cp } from 'node:fs/promises';
import { join } from 'node:path';
import { test } from 'node:test';
import { openWindow, PATIENCE, setting, step, visit, watch } from './support/browser.mjs';
import { temporaryFolder } from './support/files.mjs';
import { Host } from './support/host.mjs';
import * as panel from './support/panel.mjs';
import { newerVersion } from './support/version.mjs';
import { fromOpeningToPose } from './support/workflow.mjs';

/** @typedef {import('playwright-core').Page} Page */

test('the page without a network', { timeout: 4 * PATIENCE }, async (t) => {
  const folder = await temporaryFolder();
  await cp(join(setting('FLUOROPOSE_PACKAGE'), 'site'), folder, { recursive: true });
  const host = await new Host(folder, '/some/where/').start();
  const page = await openWindow();
  const troubles = watch(page, host.address);

  await step(page, t, 'it loads from a sub-folder and is kept', async () => {
    await visit(page, host.address);
    assert.equal(await page.evaluate(async () => (await navigator.serviceWorker.ready).active?.scriptURL), `${host.address}service_worker.js`);
  });

  await step(page, t, 'it can be installed', () => isInstallable(page));

  await step(page, t, 'from opening to a pose with the host gone', async () => {
    await host.stop();
    await visit(page, host.address);
    await fromOpeningToPose(page);
  });

  await step(page, t, 'a newer version is announced and changes nothing by itself', async () => {
    await newerVersion(folder);
    await host.start();
    const before = await panel.shownPose(page);
    await page.evaluate(() => navigator.serviceWorker.ready.then((registration) => registration.update()));
    await page.getByRole('button', { name: 'Update' }).waitFor();
    assert.equal(await edition(page), null, 'the page is the one that was opened');
    assert.deepEqual(await panel.shownPose(page), before);
  });

  await step(page, t, 'it takes over when somebody says so', async () => {
    page.on('dialog', (dialog) => dialog.accept());
    await page.getByRole('button', { name: 'Update' }).click();
    await page.locator('meta[name=edition]').waitFor({ state: 'attached' });
    assert.equal(await edition(page), 'second');
    assert.equal(await page.getByRole('button', { name: 'Update' }).count(), 0);
  });

  await page.context().close();
  assert.deepEqual(troubles, [], 'the page threw, logged an error, or asked another computer');
});

/** The browser's own judgement. @param {Page} page */
async function isInstallable(page) {
  const browser = await page.context().newCDPSession(page);
  const { errors, url, data } = await browser.send('Page.getAppManifest');
  assert.deepEqual(errors, []);
  assert.match(url, /\/some\/where\/manifest\.webmanifest$/);
  assert.equal(JSON.parse(data ?? '').start_url, './');
  const { installabilityErrors } = await browser.send('Page.getInstallabilityErrors');
  const obstacles = installabilityErrors.map(({ errorId }) => errorId);
  // Test windows keep nothing, and nothing can be installed from such a window.
  assert.deepEqual(obstacles.filter((id) => id !== 'in-incognito'), []);
  await browser.detach();
}

/** @param {Page} page */
function edition(page) {
  return page.evaluate(() => document.querySelector('meta[name=edition]')?.getAttribute('content') ?? null);
}
