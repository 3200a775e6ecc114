/** Keys and mouse: what people of this field are used to, and what must not be lost on the way. */
import assert from 'node:assert/strict';
import { drawn, pageTest, screenshot, step, until } from './support/browser.mjs';
import { choose } from './support/files.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { demoFile, framePath } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./support/study.mjs').Point} Point */

/** Three corners of a draft, and a place where nothing is. */
const CORNERS = /** @type {Point[]} */ ([[400, 400], [600, 400], [600, 600]]);
const ELSEWHERE = /** @type {Point} */ ([700, 300]);
/** The readout has tenths, and a pixel of the screen is more than one of the frame. */
const SAME_PLACE = 0.25;

pageTest('keys and mouse', async (page, t) => {
  const stage = new Stage(page);
  await choose(page, await demoFile(framePath(1)), await demoFile(framePath(2)), await demoFile(framePath(3)));
  await panel.waitForFrames(page, 3);
  await stage.learn();

  await step(page, t, 'F and D go through the frames and stop at the ends', async () => {
    const seen = [];
    for (const key of ['f', 'f', 'f', 'd', 'd', 'd', 'PageDown', 'ArrowLeft', 'ArrowRight']) {
      await page.keyboard.press(key);
      seen.push(await frameShown(page));
    }
    assert.deepEqual(seen, [2, 3, 3, 2, 1, 1, 2, 1, 2]);
    await page.keyboard.press('PageUp');
  });

  await step(page, t, 'left and right point once other arrows have, until the mouse moves', async () => {
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('ArrowRight');
    assert.equal(await frameShown(page), 1);
    await page.mouse.move(500, 300);
    await page.keyboard.press('ArrowRight');
    assert.equal(await frameShown(page), 2);
    await page.keyboard.press('PageUp');
  });

  await step(page, t, 'Ctrl+Z and Ctrl+Y take points back and bring them again', async () => {
    await page.keyboard.press('p');
    for (const corner of CORNERS) await stage.click(corner);
    await draftHas(page, 3);
    await page.keyboard.press('Control+z');
    await draftHas(page, 2);
    await page.keyboard.press('Control+z');
    await draftHas(page, 1);
    await page.keyboard.press('Control+y');
    await draftHas(page, 2);
    await page.keyboard.press('Control+Shift+z');
    await draftHas(page, 3);
  });

  await step(page, t, '? opens the key sheet, Esc closes it, the draft stays', () => keySheet(page, stage));
  await step(page, t, 'a wheel zoom keeps what is under the cursor', () => wheelZooms(page, stage));
  await step(page, t, 'a middle drag moves the frame with the hand', () => middlePans(page, stage));
  await step(page, t, 'a right drag changes window and level, R takes it back', () => rightWindows(page, stage));
  await step(page, t, 'none of it touched the draft', () => draftHas(page, 3, stage));
});

/** @param {Page} page */
async function frameShown(page) {
  await drawn(page);
  return 1 + (await panel.slider(page, 'Frame'));
}

/** The bottom line counts the points of a draft. @param {Page} page @param {number} count @param {Stage} [stage] */
async function draftHas(page, count, stage) {
  if (stage) await stage.hover(ELSEWHERE);
  await panel.waitForWords(page, new RegExp(`^${count} points?\\.`));
}

/** @param {Page} page @param {Stage} stage */
async function keySheet(page, stage) {
  const before = await stage.picture();
  await page.keyboard.press('?');
  const sheet = page.getByRole('dialog', { name: 'Keys and mouse' });
  for (const group of ['Tracing', 'Mouse', 'Seeing', 'Working']) await sheet.getByRole('region', { name: group }).waitFor();
  await screenshot(page, 'keys');
  await page.keyboard.press('Escape');
  await sheet.waitFor({ state: 'hidden' });
  await stage.looksLike(before, 'the draft');
  await draftHas(page, 3, stage);
}

/** @param {Page} page @param {Stage} stage */
async function wheelZooms(page, stage) {
  for (const place of /** @type {Point[]} */ ([[300, 350], [820, 640]])) {
    await stage.hover(place);
    const before = await stage.readout();
    const { scale } = stage.view;
    await page.mouse.wheel(0, -200);
    near(await stage.readout(), before, SAME_PLACE);
    await page.mouse.wheel(0, -200);
    near(await stage.readout(), before, SAME_PLACE);
    await stage.learn();
    const ratio = stage.view.scale / scale;
    assert(Math.abs(ratio - 2 ** (400 / 300)) < 0.02, `two turns of the wheel zoom ${ratio} times`);
    await page.keyboard.press('0');
    await stage.learn();
    assert(Math.abs(stage.view.scale / scale - 1) < 0.002, '0 fits the frame again');
  }
}

/** @param {Page} page @param {Stage} stage */
async function middlePans(page, stage) {
  const before = { ...stage.view };
  await stage.hover([300, 300]);
  const grip = await stage.readout();
  await stage.drag([300, 300], [360, 420], 'middle');
  near(await stage.readout(), grip, SAME_PLACE);
  await stage.learn();
  assert(stage.view.left > before.left + 10 && stage.view.top > before.top + 10, 'the frame moved right and down');
  await page.keyboard.press('0');
  await stage.learn();
}

/** @param {Page} page @param {Stage} stage */
async function rightWindows(page, stage) {
  const shown = () => panel.windowAndLevel(page);
  const before = await shown();
  await stage.drag([300, 500], [400, 500], 'right');
  await drawn(page);
  const [width, level] = await until(shown, ([width]) => width > before[0], 'a wider window');
  assert.equal(level, before[1], 'sideways changes the width alone');
  await stage.drag([300, 500], [300, 600], 'right');
  await until(shown, (now) => now[0] === width && now[1] < level, 'a lower level: down brightens');
  await page.keyboard.press('r');
  await until(shown, (now) => now[0] === before[0] && now[1] === before[1], 'window and level of the frame');
}

/** @param {Point} point @param {Point} wanted @param {number} within px */
function near(point, wanted, within) {
  const away = Math.hypot(point[0] - wanted[0], point[1] - wanted[1]);
  assert(away <= within, `${point} is ${away.toFixed(2)} px away from ${wanted}`);
}
