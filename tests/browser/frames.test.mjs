/** Frames of every kind, by the file chooser and by drag and drop, down to their grey values. */
import assert from 'node:assert/strict';
import { mkdir, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { pageTest, step, visit } from './support/browser.mjs';
import { choose, drop, dropPaths, temporaryFolder } from './support/files.mjs';
import { dicom, greyAt, jpeg, png, SIZE, tiff } from './support/frames.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { demoFile, framePath } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */

const TIMES_16 = (/** @type {number} */ grey) => 16 * grey;
const TIMES_200 = (/** @type {number} */ grey) => 200 * grey;
const REVERSED = (/** @type {number} */ grey) => 65_535 - 200 * grey;
const SAME = (/** @type {number} */ grey) => grey;
const JPEG_GREY = 137;

/** What is opened, the frames it holds, and a pixel's value by the pattern's. */
const KINDS = [
  { what: 'an 8-bit PNG', make: async () => png(8), frames: [SAME] },
  { what: 'a 16-bit PNG', make: async () => png(16, TIMES_200), frames: [TIMES_200] },
  { what: 'a JPEG', make: (/** @type {Page} */ page) => jpeg(page, JPEG_GREY), frames: [() => JPEG_GREY] },
  { what: 'a TIFF of two 16-bit pages', make: async () => tiff([TIMES_200, REVERSED]), frames: [TIMES_200, REVERSED] },
  { what: 'a DICOM file of two frames', make: async () => dicom([TIMES_16, SAME]), frames: [TIMES_16, SAME] },
];

pageTest('what is dropped before the page has begun is opened once it has, into the work that comes back', async (page) => {
  await drop(page, await demoFile(framePath(1)), await demoFile(framePath(2)));
  await panel.waitForFrames(page, 2);
  await panel.waitUntilKept(page);
  // The module without which nothing begins is held back.
  let letGo = () => undefined;
  const held = new Promise((resolve) => (letGo = () => void resolve(undefined)));
  await page.route(/fluoropose_page_bg.*\.wasm$/, async (route) => {
    await held;
    await route.continue();
  });
  const asked = page.waitForRequest(/fluoropose_page_bg.*\.wasm$/);
  await page.reload({ waitUntil: 'commit' });
  await asked;
  await drop(page, await demoFile(framePath(3)));
  letGo();
  await panel.waitForFrames(page, 3);
  await panel.waitForWords(page, /Opened the frame 0003\.png/);
});

pageTest('frames of every kind', async (page, t) => {
  const stage = new Stage(page);
  for (const { what, make, frames } of KINDS) {
    for (const [how, open] of /** @type {const} */ ([['chosen', choose], ['dropped', drop]])) {
      await step(page, t, `${what}, ${how}`, async () => {
        await visit(page);
        await open(page, await make(page));
        await panel.waitForFrames(page, frames.length);
        await hasGreys(page, stage, frames);
      });
    }
  }

  await step(page, t, 'the window a DICOM file asks for', async () => {
    await visit(page);
    await choose(page, dicom([TIMES_16]));
    await panel.waitForFrames(page, 1);
    const [width, level] = await panel.windowAndLevel(page);
    // PS3.3 C.11.2.1.2.1: the exact width is one less, the exact centre half a value lower.
    assert(Math.abs(width - 600) <= 1 && Math.abs(level - 1000) <= 1, `window ${width}, level ${level}`);
  });

  await step(page, t, 'a folder of frames, in the order of their numbers', async () => {
    await visit(page);
    const folder = join(await temporaryFolder(), 'study');
    await mkdir(join(folder, 'inner'), { recursive: true });
    const names = ['knee10.png', 'knee9.png', join('inner', 'knee2.png')];
    await Promise.all(names.map((name, index) => writeFile(join(folder, name), png(8, (grey) => (grey + index) % 256).buffer)));
    await dropPaths(page, [folder]);
    await panel.waitForFrames(page, 3);
    await stand(page, 'knee2.png', 'knee9.png', 'knee10.png');
  });

  await step(page, t, 'DICOM files whose own numbers are another order than their names: a person says which is meant', async () => {
    await visit(page);
    const shifted = (/** @type {number} */ by) => (/** @type {number} */ grey) => grey + by;
    await choose(page, ...[['1.2.1', 3], ['1.2.2', 1], ['1.2.9', 2]].map(([name, number], at) => dicom([shifted(at)], { name: String(name), number: Number(number) })));
    await panel.waitForFrames(page, 3);
    await panel.waitForWords(page, /another order \(Instance Number\): 1\.2\.1 is first by name, 1\.2\.2 by number/);
    await stand(page, '1.2.1', '1.2.2', '1.2.9');
    await page.getByRole('button', { name: 'Order by number' }).click();
    await panel.waitForWords(page, /stand by the numbers in their files/);
    await stand(page, '1.2.2', '1.2.9', '1.2.1');
    await page.getByRole('button', { name: /^Undo: order the frames by number/ }).click();
    await stand(page, '1.2.1', '1.2.2', '1.2.9');
  });
});

/** @param {Page} page @param {string[]} names */
async function stand(page, ...names) {
  for (const [index, name] of names.entries()) {
    await page.getByRole('slider', { name: 'Frame', exact: true }).fill(String(index));
    await page.getByRole('application', { name: new RegExp(`^${name}, frame ${index + 1} of ${names.length}`) }).waitFor();
  }
}

/**
 * Every frame has the right size and the right grey values under the mouse.
 *
 * @param {Page} page
 * @param {Stage} stage
 * @param {((grey: number) => number)[]} frames
 */
async function hasGreys(page, stage, frames) {
  for (const [index, change] of frames.entries()) {
    await page.getByRole('application', { name: new RegExp(`frame ${index + 1} of`) }).waitFor();
    await stage.learn();
    for (const [column, row] of [[0, 0], [SIZE.width - 1, SIZE.height - 1], [9, 5]]) {
      assert.equal(await stage.greyAt([column + 0.5, row + 0.5]), change(greyAt(column, row)), `pixel ${column}, ${row} of frame ${index + 1}`);
    }
    await stage.hover([SIZE.width + 0.15, 5.5]);
    await stage.readout();
    assert.doesNotMatch(await page.getByRole('contentinfo', { name: 'Status' }).innerText(), / px · \d/, 'the frame ends where it should');
    await page.keyboard.press('f');
  }
}
