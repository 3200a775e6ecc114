/** Going through the work: what is next, what was checked, flags and notes, the list. */
import assert from 'node:assert/strict';
import { drawn, pageTest, screenshot, step, until, visit } from './support/browser.mjs';
import { exported } from './support/exporting.mjs';
import { choose, drop, file } from './support/files.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { demoFile, framePath } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */

const POSED = 3;
/** The least side of a target, CSS px (WCAG 2.2, 2.5.8). */
const TARGET = 24;

pageTest('working through a film', async (page, t) => {
  const stage = new Stage(page);
  await step(page, t, 'three of eight frames have both poses', async () => {
    const frames = await Promise.all(Array.from({ length: 8 }, (_, index) => demoFile(framePath(index + 1))));
    await choose(page, ...frames, await demoFile('calibration.txt'));
    await panel.waitForFrames(page, 8);
    await choose(page, await firstPoses('femur'), await firstPoses('tibia'));
    await until(() => panel.cells(page), (cells) => cells.filter((name) => name.endsWith(': pose loaded')).length === 6, 'six poses');
    await page.getByRole('combobox', { name: 'Side of the body' }).selectOption('left');
    await screenshot(page, 'working');
  });

  await step(page, t, 'every cell is large enough to hit', () => cellsAreLarge(page));
  await step(page, t, 'N and Shift+N go to what has no pose, component by component', () => goesToUnfinished(page));
  await step(page, t, 'Y, Shift+Y and Shift+J mark, flag and note; undo takes them back', () => marks(page));
  await step(page, t, 'a check is of what was looked at', () => checksOutdate(page, stage));
  await step(page, t, 'the list filters, and goes where it is told', () => list(page));

  await step(page, t, 'marks are in the session file', async () => {
    const session = await exported(page, 'Session');
    await visit(page);
    await drop(page, session);
    await panel.waitForFrames(page, 8);
    await cell(page, 'Frame 2, femur: pose loaded, flagged').click();
    await until(() => page.getByRole('textbox', { name: 'Note on frame 2, femur' }).inputValue(), (text) => text === 'rim hidden', 'the note');
  });
});

/** The true poses of the first frames, rows of NaN for the others: no library has to be built for them. @param {'femur' | 'tibia'} component */
async function firstPoses(component) {
  const lines = (await demoFile(`${component}.jts`)).buffer.toString().trimEnd().split(/\r?\n/);
  const rows = lines.map((line, at) => (at < 2 + POSED ? line : 'NaN, NaN, NaN, NaN, NaN, NaN'));
  return file(`${component}.jts`, `${rows.join('\n')}\n`);
}

/** @param {Page} page @param {string} name */
function cell(page, name) {
  return page.getByRole('table', { name: 'Frames and components' }).getByRole('button', { name, exact: true });
}

/** @param {Page} page */
async function cellsAreLarge(page) {
  const buttons = page.getByRole('table', { name: 'Frames and components' }).getByRole('button');
  await drawn(page);
  for (const box of await buttons.evaluateAll((all) => all.map((button) => button.getBoundingClientRect().toJSON()))) {
    assert(box.width >= TARGET && box.height >= TARGET, `a cell of ${box.width} x ${box.height}`);
  }
}

/** Where the page is. @param {Page} page */
async function here(page) {
  const name = await page.getByRole('application', { name: /outline$/ }).getAttribute('aria-label');
  const [, frame, component] = /frame (\d+) of \d+.*\. (Femur|Tibia) outline$/.exec(name ?? '') ?? [];
  return `${frame} ${component}`;
}

/** @param {Page} page */
async function goesToUnfinished(page) {
  await cell(page, 'Frame 1, femur: pose loaded').click();
  const seen = [];
  for (const key of ['n', 'n', 'Shift+n', 'Shift+n']) {
    const before = await here(page);
    await page.keyboard.press(key);
    seen.push(await until(() => here(page), (now) => now !== before, 'to go on'));
  }
  assert.deepEqual(seen, ['4 Femur', '5 Femur', '4 Femur', '8 Tibia']);
  await panel.waitForWords(page, /^Frame 8, tibia: empty\.$/);
}

/** @param {Page} page */
async function marks(page) {
  await cell(page, 'Frame 2, femur: pose loaded').click();
  await page.keyboard.press('y');
  await cell(page, 'Frame 2, femur: pose loaded, checked').waitFor();
  await page.getByRole('button', { name: 'Checked', exact: true, pressed: true }).waitFor();
  await page.keyboard.press('Shift+y');
  await cell(page, 'Frame 2, femur: pose loaded, checked, flagged').waitFor();
  await page.keyboard.press('Shift+j');
  const note = page.getByRole('textbox', { name: 'Note on frame 2, femur' });
  await until(() => note.evaluate((field) => field === document.activeElement), (focused) => focused, 'the note to be in hand');
  await page.keyboard.type('rim hidden');
  await page.keyboard.press('Enter');
  await until(() => note.inputValue(), (text) => text === 'rim hidden', 'the note to be there');
  for (const left of ['pose loaded, checked, flagged', 'pose loaded, checked', 'pose loaded']) {
    await page.keyboard.press('Control+z');
    await cell(page, `Frame 2, femur: ${left}`).waitFor();
    await until(() => note.inputValue(), (text) => text === '', 'the note to be gone');
  }
  for (let redone = 0; redone < 3; redone++) await page.keyboard.press('Control+y');
  await cell(page, 'Frame 2, femur: pose loaded, checked, flagged').waitFor();
  await until(() => note.inputValue(), (text) => text === 'rim hidden', 'the note to be back');
}

/** @param {Page} page @param {Stage} stage */
async function checksOutdate(page, stage) {
  await stage.learn();
  await page.keyboard.press('p');
  await stage.click([500, 500]);
  await cell(page, 'Frame 2, femur: draft, changed since it was checked, flagged').waitFor();
  await page.keyboard.press('Control+z');
  await cell(page, 'Frame 2, femur: pose loaded, checked, flagged').waitFor();
  await page.keyboard.press('y');
  await cell(page, 'Frame 2, femur: pose loaded, flagged').waitFor();
}

/** @param {Page} page */
async function list(page) {
  await page.keyboard.press('j');
  const sheet = page.getByRole('dialog', { name: 'Work list' });
  const rows = sheet.getByRole('table', { name: 'Work list' }).getByRole('row');
  await until(() => rows.count(), (count) => count === 1 + 16, 'a row for each component of each frame');
  await sheet.getByRole('radio', { name: 'Unfinished 10' }).click();
  await until(() => rows.count(), (count) => count === 1 + 10, 'ten rows');
  await sheet.getByRole('radio', { name: 'Unchecked 6' }).waitFor();
  await sheet.getByRole('radio', { name: 'Flagged 1' }).click();
  await until(() => rows.count(), (count) => count === 1 + 1, 'one row');
  assert.match(await rows.nth(1).innerText(), /pose loaded/);
  assert.equal(await sheet.getByRole('textbox', { name: 'Note on frame 2, femur' }).inputValue(), 'rim hidden');
  await screenshot(page, 'work list');
  await sheet.getByRole('radio', { name: 'All 16' }).click();
  await sheet.getByRole('checkbox', { name: 'Frame 3, tibia, checked' }).check();
  await cell(page, 'Frame 3, tibia: pose loaded, checked').waitFor();
  await sheet.getByRole('button', { name: 'Go to frame 3, tibia' }).click();
  assert.equal(await until(() => here(page), (now) => now === '3 Tibia', 'frame 3'), '3 Tibia');
  await page.keyboard.press('Escape');
  await sheet.waitFor({ state: 'hidden' });
}

pageTest('a long film', async (page, t) => {
  await step(page, t, 'all of it is in sight, and each of its cells can be pressed', async () => {
    const { png } = await import('./support/frames.mjs');
    const frames = Array.from({ length: 60 }, (_, index) => ({ ...png(8, (grey) => (grey + index) % 256), name: `film${index + 1}.png` }));
    await choose(page, ...frames);
    await panel.waitForFrames(page, 60);
    const isInView = (/** @type {Element} */ button) => {
      const { left, right, top } = button.getBoundingClientRect();
      return left >= 0 && right <= innerWidth && document.elementFromPoint((left + right) / 2, top + 5) === button;
    };
    for (const frame of [1, 30, 60]) await until(() => cell(page, `Frame ${frame}, femur: empty`).evaluate(isInView), (inView) => inView, `frame ${frame} to be in sight`);
    await cell(page, 'Frame 53, tibia: empty').click();
    await page.getByRole('application', { name: /frame 53 of 60, tracing the tibia/ }).waitFor();
    await screenshot(page, 'long film');
  });
});
