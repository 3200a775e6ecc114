/** Ways in which work ends without being asked, and what has to be there afterwards. */
import assert from 'node:assert/strict';
import { cp } from 'node:fs/promises';
import { join } from 'node:path';
import { ADDRESS, openWindow, setting, until } from '../support/browser.mjs';
import { evict } from '../support/eviction.mjs';
import { openExport } from '../support/exporting.mjs';
import { choose, temporaryFolder } from '../support/files.mjs';
import { Host } from '../support/host.mjs';
import { startBrowser } from '../support/own_browser.mjs';
import * as panel from '../support/panel.mjs';
import { demoFile } from '../support/study.mjs';
import { newerVersion } from '../support/version.mjs';
import { savedState, Work } from './work.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./work.mjs').Random} Random */
/** @typedef {{ work: Work, page: Page }[]} Ended the works, and the pages that have to hold them */

const EDITS = 8;
const DAY_MS = 24 * 3600 * 1000;

/** @type {Record<string, (random: Random, title: string) => Promise<Ended>>} */
export const ENDS = {
  'tab crashes': async (random, title) => {
    const work = await begun(await window(), random, title);
    await work.edit(EDITS);
    return [{ work, page: await afterCrash(work.page) }];
  },

  'browser is killed': async (random, title) => {
    const profile = await temporaryFolder();
    const first = await startBrowser(profile);
    const work = await new Work(await first.page(), random, title).begin();
    await work.edit(EDITS);
    await first.kill();
    return [{ work, page: await (await startBrowser(profile)).page() }];
  },

  'worker crashes': async (random, title) => {
    const page = await window();
    const work = await begun(page, random, title);
    // Libraries are built, and again after a crash.
    if (random() < 0.5) await choose(page, await demoFile('calibration.txt'), await demoFile('femur.stl'));
    for (let round = 0; round < 3; round++) {
      await work.edit(3);
      for (const worker of page.workers()) await worker.evaluate(() => void setTimeout(() => { throw new Error('made to crash'); })).catch(() => undefined);
    }
    await work.edit(1);
    if (random() < 0.5) await work.rest();
    return [{ work, page: await afterCrash(page) }];
  },

  'storage is full': async (random, title) => {
    // From the beginning: the browser remembers for minutes how much room there was.
    const page = await window();
    await quota(page, 1);
    const work = await new Work(page, random, title).open();
    await until(() => savedState(page), (text) => text === 'Not saved', 'the page to say that nothing is saved');
    await work.edit(EDITS / 2);
    if (random() < 0.7) await quota(page, null);
    if (random() < 0.7) await new Promise((resolve) => setTimeout(resolve, 6000));
    await work.edit(2);
    await work.look();
    return [{ work, page: await afterCrash(page) }];
  },

  'quota of 5 MB': async (random, title) => {
    const page = await window();
    await quota(page, 5_000_000);
    const work = await begun(page, random, title);
    for (let round = 0; round < 3; round++) {
      await work.addFrame(1_500_000 + Math.floor(1_000_000 * random()));
      await work.edit(2);
    }
    await work.look();
    return [{ work, page: await afterCrash(page) }];
  },

  'storage is evicted': async (random, title) => {
    const page = await window();
    const work = await begun(page, random, title);
    await work.edit(EDITS / 2);
    // A write may be under way: what is in the page when the storage goes has to be kept again, with an edit or without.
    await evict(page);
    work.evicted();
    if (random() < 0.5) await work.edit(2);
    else await new Promise((resolve) => setTimeout(resolve, 2000));
    // What it was saving when it crashed may be there in part; what it shows as saved is there.
    if (random() < 0.5) await work.rest();
    else await work.look();
    return [{ work, page: await afterCrash(page) }];
  },

  'two tabs': async (random, title) => {
    const page = await window();
    const one = await begun(page, random, `${title} a`);
    const other = await begun(await tab(page), random, `${title} b`);
    for (let round = 0; round < 3; round++) {
      await page.bringToFront();
      await one.edit(2);
      await other.page.bringToFront();
      await other.edit(2);
    }
    if (random() < 0.5) {
      await crash(other.page);
      const again = await tab(page);
      return [{ work: one, page }, { work: other, page: again }];
    }
    await Promise.all([crash(one.page), crash(other.page)]);
    // The later one comes back first; a second tab brings the other.
    const [first, second] = [await tab(page), await tab(page)];
    const isFirst = await holds(first, other);
    return isFirst ? [{ work: other, page: first }, { work: one, page: second }] : [{ work: one, page: first }, { work: other, page: second }];
  },

  'clock set back': async (random, title) => {
    const page = await window();
    const old = await begun(page, random, `${title} a`);
    await old.edit(2);
    await old.rest();
    const aside = random() < 0.5;
    const next = aside ? page : await tab(page);
    if (aside) await startAnew(page);
    await next.evaluate((shift) => {
      const now = Date.now.bind(Date);
      Date.now = () => now() - shift;
    }, DAY_MS * Math.ceil(30 * random()));
    const work = await begun(next, random, `${title} b`);
    await work.edit(EDITS / 2);
    if (!aside) {
      const again = await afterCrash(next);
      return [{ work, page: again }, { work: old, page }];
    }
    const again = await afterCrash(next);
    return [{ work, page: again }];
  },

  'reload in any state': async (random, title) => {
    const page = await window();
    const work = await begun(page, random, title);
    await work.edit(1 + Math.floor(EDITS * random()));
    const states = [
      async () => undefined,
      async () => work.press(),
      async () => void (await openExport(page, 'Session')),
      async () => page.keyboard.press('?'),
      async () => page.getByRole('textbox', { name: 'Name of the study' }).focus(),
      async () => choose(page, await demoFile('calibration.txt'), await demoFile('femur.stl')),
      async () => page.keyboard.press('j'),
    ];
    await states[Math.floor(states.length * random())]();
    page.on('dialog', (dialog) => void dialog.accept());
    await page.reload();
    return [{ work, page }];
  },

  'upgrade in mid-work': async (random, title) => {
    const folder = await temporaryFolder();
    await cp(join(setting('FLUOROPOSE_PACKAGE'), 'site'), folder, { recursive: true });
    const host = await new Host(folder, '/some/where/').start();
    const page = await openWindow();
    await page.goto(host.address);
    await page.evaluate(async () => void (await navigator.serviceWorker.ready));
    // From now on by the worker.
    await page.reload();
    await page.getByRole('button', { name: 'Open the demonstration' }).waitFor();
    const work = await begun(page, random, title);
    await work.edit(2);
    await newerVersion(folder);
    await page.evaluate(() => navigator.serviceWorker.ready.then((registration) => registration.update()));
    await page.getByRole('button', { name: 'Update' }).waitFor();
    await work.edit(EDITS / 2);
    page.on('dialog', (dialog) => void dialog.accept());
    await page.getByRole('button', { name: 'Update' }).click();
    await page.locator('meta[name=edition]').waitFor({ state: 'attached' });
    return [{ work, page }];
  },

  'private window': async (random, title) => {
    // Windows of this driver are private: what was in one is in no other, and in no tab after the last is closed.
    const page = await window();
    const work = await begun(page, random, title);
    await work.edit(EDITS);
    const next = await tab(page, 'about:blank');
    // It asks nothing unless something waits; as long as it is there, its work belongs to it.
    page.on('dialog', (dialog) => void dialog.accept());
    const closed = page.waitForEvent('close');
    await page.close({ runBeforeUnload: random() < 0.5 });
    await closed;
    await next.goto(ADDRESS);
    const stranger = await window();
    await stranger.getByRole('button', { name: 'Open the demonstration' }).waitFor();
    await stranger.context().close();
    return [{ work, page: next }];
  },

  'left for other work': async (random, title) => {
    const page = await window();
    const full = random() < 0.5;
    if (full) await quota(page, 1);
    const left = new Work(page, random, `${title} a`);
    await (full ? left.open() : left.begin());
    await left.edit(EDITS / 2);
    await startAnew(page);
    if (full) await quota(page, null);
    const work = await new Work(page, random, `${title} b`).open();
    // As long as something of either waits, the page says so.
    await work.rest();
    left.saved = left.states.length - 1;
    const again = await afterCrash(page);
    const other = await tab(again);
    await openEarlier(other, left);
    return [{ work, page: again }, { work: left, page: other }];
  },
};

/** What needs no debugger of Chromium, which makes tabs crash and storage full. */
export const WITHOUT_DEBUGGER = ['browser is killed', 'reload in any state'];

/** A new window with the page. */
async function window() {
  const page = await openWindow({ serviceWorkers: 'block' });
  await page.goto(ADDRESS);
  await page.getByRole('button', { name: 'Open the demonstration' }).waitFor();
  return page;
}

/** @param {Page} page @param {Random} random @param {string} title */
function begun(page, random, title) {
  return new Work(page, random, title).begin();
}

/** Another tab of the same window. @param {Page} page @param {string} [address] */
async function tab(page, address = ADDRESS) {
  const next = await page.context().newPage();
  await next.goto(address);
  return next;
}

/** @param {Page} page */
async function crash(page) {
  const crashed = new Promise((resolve) => page.once('crash', resolve));
  const session = await page.context().newCDPSession(page);
  session.send('Page.crash').catch(() => undefined);
  await crashed;
}

/** @param {Page} page */
async function afterCrash(page) {
  await crash(page);
  return tab(page);
}

/** @param {Page} page @param {number | null} bytes null: as it was */
async function quota(page, bytes) {
  const session = await page.context().newCDPSession(page);
  const origin = new URL(ADDRESS).origin;
  await session.send('Storage.overrideQuotaForOrigin', bytes === null ? { origin } : { origin, quotaSize: bytes });
}

/** @param {Page} page */
async function startAnew(page) {
  await page.keyboard.press('Escape');
  await page.keyboard.press('Shift+Alt+n');
  await page.getByRole('button', { name: 'Open the demonstration' }).waitFor();
}

/** Does this page show that work? @param {Page} page @param {Work} work */
async function holds(page, work) {
  const field = page.getByRole('textbox', { name: 'Name of the study' });
  await field.waitFor();
  const name = await until(() => field.inputValue(), (text) => text !== '', 'the study to have a name');
  return name.startsWith(work.title);
}

/** @param {Page} page @param {Work} work */
async function openEarlier(page, work) {
  const buttons = page.getByRole('button', { name: new RegExp(`^Open ${work.title}.* as it was left$`) });
  await page.getByRole('button', { name: 'Open the demonstration' }).waitFor();
  await buttons.first().click();
  assert(await holds(page, work));
}
