/** Kept in the browser: a tab that dies in the middle of a trace comes back with everything. */
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { isDeepStrictEqual } from 'node:util';
import { ADDRESS, atRest, drawn, IN_FIREFOX, pageTest, PATIENCE, screenshot, step, until } from './support/browser.mjs';
import { evict } from './support/eviction.mjs';
import { exported, openExport, savedFile } from './support/exporting.mjs';
import { choose, temporaryFolder } from './support/files.mjs';
import { png } from './support/frames.mjs';
import { startBrowser } from './support/own_browser.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { demoFile, framePath } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./support/study.mjs').Point} Point */

/** A draft that is under way when the tab dies, and where it goes on. */
const DRAFT = /** @type {Point[]} */ ([[400, 700], [520, 700], [520, 820]]);
/** An outline that is closed. */
const TRACED = /** @type {Point[]} */ ([[400, 500], [620, 520], [600, 640], [410, 620]]);
const FRAMES = 3;
const NEXT = /** @type {Point} */ ([400, 820]);
const ELSEWHERE = /** @type {Point} */ ([700, 300]);
const NOTE = 'tab died here';

/** What only Chromium's protocol can do to a tab. */
const crashTest = IN_FIREFOX ? (/** @type {string} */ name) => test(name, { skip: 'Firefox has no such protocol' }) : pageTest;

crashTest('a tab that crashes in the middle of a trace', async (page, t) => {
  /** @type {Awaited<ReturnType<typeof begin>> | null} */
  let work = null;
  let next = page;
  await step(page, t, 'work is begun and kept', async () => {
    work = await begin(page);
  });

  await step(page, t, 'the tab crashes; a new one has everything', async () => {
    const crashed = new Promise((resolve) => page.once('crash', resolve));
    const tab = await page.context().newCDPSession(page);
    tab.send('Page.crash').catch(() => undefined);
    await crashed;
    next = await page.context().newPage();
    await next.goto(ADDRESS);
    assert(work);
    await hasEverything(next, work);
    await screenshot(next, 'restored');
  });

  await step(page, t, 'the trace goes on where it was', async () => {
    const stage = new Stage(next);
    await stage.learn();
    await stage.click(NEXT);
    await stage.hover(ELSEWHERE);
    await panel.waitForWords(next, /^4 points\./);
  });

  await step(page, t, 'Start anew leaves it, and undo brings it back', async () => {
    await next.keyboard.press('Shift+Alt+n');
    await next.getByRole('button', { name: 'Open the demonstration' }).waitFor();
    await next.keyboard.press('Control+z');
    await panel.waitForFrames(next, FRAMES);
    await until(() => panel.cells(next), (cells) => cells.includes('Frame 3, tibia: draft'), 'the draft');
  });

  await step(page, t, 'what was left stays under Earlier work, and can be opened and deleted', () => earlierWork(next));
});

test('a browser that is killed in the middle of a trace', { timeout: 3 * PATIENCE, skip: IN_FIREFOX }, async (t) => {
  const profile = await temporaryFolder();
  const first = await startBrowser(profile);
  const page = await first.page();
  const work = await begin(page);
  await t.test('it is killed, and started again with the same profile', async () => {
    await first.kill();
    const second = await startBrowser(profile);
    const again = await second.page();
    await hasEverything(again, work);
    await second.kill();
  });
});

test('storage that is cleared under work that came back from it', { timeout: 3 * PATIENCE, skip: IN_FIREFOX }, async (t) => {
  const profile = await temporaryFolder();
  const originals = [1, 2, 3].map((shift) => ({ ...png(8, (grey) => (grey + shift) % 256), name: `${shift}.png` }));
  const first = await startBrowser(profile);
  const before = await first.page();
  await choose(before, ...originals);
  await panel.waitForFrames(before, FRAMES);
  await note(before, NOTE);
  await panel.waitUntilKept(before);
  await first.kill();
  const second = await startBrowser(profile);
  const page = await second.page();

  await t.test('the page names the files of which that was the only copy, and does not say that they are saved', async () => {
    await panel.waitForFrames(page, FRAMES);
    await panel.waitUntilKept(page);
    await evict(page);
    await saved(page, /^Not saved/);
    await panel.waitForWords(page, /no copy any more of 1\.png, 2\.png and 3\.png, .*: drop the originals/);
  });

  await t.test('a session file is without them, and that is said', async () => {
    const sheet = await openExport(page, 'Session');
    const session = JSON.parse((await savedFile(page)).buffer.toString());
    assert.deepEqual(session.files.map((/** @type {{ base64: string | null }} */ { base64 }) => base64), [null, null, null]);
    await panel.waitForWords(page, /Session saved, but without the bytes of 1\.png, 2\.png and 3\.png/);
    await sheet.press('Escape');
  });

  await t.test('the originals are taken, and all is saved and comes back', async () => {
    await choose(page, ...originals);
    await saved(page, /^Saved/);
    await panel.waitForFrames(page, FRAMES);
    await second.kill();
    const again = await (await startBrowser(profile)).page();
    await panel.waitForFrames(again, FRAMES);
    await hasNote(noteField(again), NOTE);
    const session = JSON.parse((await exported(again, 'Session')).buffer.toString());
    assert.deepEqual(session.files.map((/** @type {{ base64: string }} */ { base64 }) => base64), originals.map(({ buffer }) => buffer.toString('base64')));
  });
});

pageTest('two tabs', async (page, t) => {
  /** @type {Page} */
  let other = page;
  await step(page, t, 'a second tab begins anew while the first has its work', async () => {
    await openSmall(page, 'first');
    other = await page.context().newPage();
    await other.goto(ADDRESS);
    await other.getByRole('button', { name: 'Open the demonstration' }).waitFor();
    await openSmall(other, 'second');
  });

  await step(page, t, 'neither writes over the other', async () => {
    await note(page, 'of the first tab');
    await note(other, 'of the second tab');
    for (const [tab, words] of /** @type {const} */ ([[page, 'of the first tab'], [other, 'of the second tab']])) {
      await panel.waitUntilKept(tab);
      await hasNote(noteField(tab), words);
    }
  });

  await step(page, t, 'a tab that has its work open cannot lose it to another', async () => {
    await openExport(other, 'Session');
    await other.getByRole('button', { name: /^Open first/ }).click();
    await panel.waitForWords(other, /open in another tab/);
    await other.keyboard.press('Escape');
  });

  await step(page, t, 'closed and opened again each comes back', async () => {
    const context = page.context();
    await other.close();
    const again = await context.newPage();
    await again.goto(ADDRESS);
    await panel.waitForFrames(again, 1);
    await hasNote(noteField(again), 'of the second tab');
    await hasNote(noteField(page), 'of the first tab');
  });
});

crashTest('storage that is full', async (page, t) => {
  const browser = await page.context().newCDPSession(page);
  const origin = new URL(ADDRESS).origin;

  await step(page, t, 'is said, and the page asks before it is closed', async () => {
    await browser.send('Storage.overrideQuotaForOrigin', { origin, quotaSize: 1 });
    await openSmall(page, 'full', 'Not saved');
    await panel.waitForWords(page, /no room left.*save a session file/);
    await page.getByRole('button', { name: 'Flag', exact: true }).click();
    const asked = page.waitForEvent('dialog');
    // Unlike the tester's own reload it does not wait for a page that never comes.
    const leaving = page.evaluate(() => location.reload()).catch(() => undefined);
    const dialog = await asked;
    assert.equal(dialog.type(), 'beforeunload');
    await dialog.dismiss();
    await leaving;
  });

  await step(page, t, 'is tried again, and the page asks no more', async () => {
    await browser.send('Storage.overrideQuotaForOrigin', { origin });
    await saved(page, /^Saved/);
    let asked = false;
    page.once('dialog', (dialog) => {
      asked = true;
      void dialog.accept();
    });
    await page.reload();
    await panel.waitForFrames(page, 1);
    assert.equal(asked, false, 'nothing was to be lost');
  });
});

/** A file of poses for so many frames: two lines of heading, then a row each. @param {{ name: string, mimeType: string, buffer: Buffer }} poses @param {number} frames */
function firstRows(poses, frames) {
  const lines = poses.buffer.toString().split('\n').slice(0, 2 + frames);
  return { ...poses, buffer: Buffer.from(lines.join('\n')) };
}

/** An outline, poses, a mark and a draft, all of it kept. @param {Page} page */
async function begin(page) {
  const stage = new Stage(page);
  const names = ['calibration.txt', ...[1, 2, 3].map(framePath)];
  await choose(page, ...(await Promise.all(names.map(demoFile))));
  await panel.waitForFrames(page, FRAMES);
  await choose(page, firstRows(await demoFile('femur.jts'), FRAMES));
  await cell(page, 'Frame 2, femur: pose loaded').click();
  // Until then that of the first frame is shown.
  await page.getByRole('application', { name: /frame 2 of 3/ }).waitFor();
  const pose = await until(() => panel.shownPose(page), (shown) => shown !== null, 'the pose that was loaded');
  await page.keyboard.press('y');
  await note(page, NOTE, 'Note on frame 2, femur');
  await cell(page, 'Frame 2, tibia: empty').click();
  await page.keyboard.press('p');
  await stage.learn();
  await stage.trace(TRACED);
  await cell(page, 'Frame 2, tibia: traced').waitFor();
  await cell(page, 'Frame 3, tibia: empty').click();
  for (const point of DRAFT) await stage.click(point);
  await stage.hover(ELSEWHERE);
  await panel.waitForWords(page, /^3 points\./);
  await panel.waitUntilKept(page);
  assert(pose, 'the pose was shown');
  return { pose, cells: await panel.cells(page) };
}

/** @param {Page} page @param {Awaited<ReturnType<typeof begin>>} work */
async function hasEverything(page, work) {
  await panel.waitForFrames(page, FRAMES);
  await panel.waitForWords(page, /is back as it was at/);
  await page.getByRole('application', { name: /frame 3 of 3, tracing the tibia/ }).waitFor();
  await until(() => panel.cells(page), (cells) => isDeepStrictEqual(cells, work.cells), 'the cells to be as they were');
  await until(() => page.getByRole('progressbar').count(), (count) => count === 0, 'the files to be back');
  const stage = new Stage(page);
  await stage.learn();
  await page.keyboard.press('p');
  await stage.hover(ELSEWHERE);
  const status = page.getByRole('contentinfo', { name: 'Status' });
  await until(() => status.innerText(), (words) => / px · \d+/.test(words), 'the frame to have its grey values');
  await panel.waitForWords(page, /^3 points\./);
  await cell(page, 'Frame 2, femur: pose loaded, checked').click();
  await panel.waitForThePose(page, work.pose);
  await hasNote(page.getByRole('textbox', { name: 'Note on frame 2, femur' }), NOTE);
  await page.getByRole('button', { name: 'Calibration: calibration.txt' }).waitFor();
  await cell(page, 'Frame 3, tibia: draft').click();
  await drawn(page);
}

pageTest('what is kept is deleted from the empty page by two clicks', async (page) => {
  await openSmall(page, 'one');
  await page.keyboard.press('Shift+Alt+n');
  await page.getByRole('button', { name: /^Delete one.* from this browser$/ }).click();
  await page.getByRole('button', { name: /^Really delete one/ }).click();
  await page.getByRole('region', { name: 'Earlier work in this browser' }).waitFor({ state: 'detached' });
  await page.reload();
  await page.getByRole('button', { name: 'Open the demonstration' }).waitFor();
  await atRest(page);
  assert.equal(await page.getByRole('region', { name: 'Earlier work in this browser' }).count(), 0);
});

/** @param {Page} page @param {string} name */
function cell(page, name) {
  return page.getByRole('table', { name: 'Frames and components' }).getByRole('button', { name, exact: true });
}

/** @param {Page} page */
async function earlierWork(page) {
  await page.keyboard.press('Shift+Alt+n');
  await page.getByRole('button', { name: 'Open the demonstration' }).waitFor();
  await openSmall(page, 'other');
  await openExport(page, 'Session');
  const earlier = page.getByRole('region', { name: 'Earlier work in this browser' });
  await screenshot(page, 'earlier work');
  await earlier.getByRole('button', { name: /^Open .* as it was left$/ }).first().click();
  await panel.waitForFrames(page, FRAMES);
  await until(() => panel.cells(page), (cells) => cells.includes('Frame 3, tibia: draft'), 'the draft');
  await openExport(page, 'Session');
  await earlier.getByRole('button', { name: /^Delete other/ }).click();
  await earlier.getByRole('button', { name: /^Really delete other/ }).click();
  await earlier.getByText('No other work is kept in this browser.').waitFor();
  await page.keyboard.press('Escape');
}

/** One small frame. @param {Page} page @param {string} name @param {string} [state] */
async function openSmall(page, name, state = 'Saved just now') {
  const shift = name.length;
  await choose(page, { ...png(8, (grey) => (grey + shift) % 256), name: `${name}.png` });
  await panel.waitForFrames(page, 1);
  await saved(page, new RegExp(`^${state}`));
}

/** @param {Page} page @param {string} words @param {string} [name] of the field */
async function note(page, words, name = 'Note on frame 1, femur') {
  await page.getByRole('textbox', { name }).fill(words);
}

/** @param {Page} page */
function noteField(page) {
  return page.getByRole('textbox', { name: 'Note on frame 1, femur' });
}

/** @param {import('playwright-core').Locator} field @param {string} words */
function hasNote(field, words) {
  return until(() => field.inputValue(), (text) => text === words, `the note "${words}"`);
}

/** Waits for what the top bar says of saving. @param {Page} page @param {RegExp} words */
function saved(page, words) {
  return until(() => page.getByRole('group', { name: 'Saved state' }).innerText(), (text) => words.test(text), `the top bar to say ${words}`);
}
