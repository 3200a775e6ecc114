/** How frames and models are shown, and what helps the eye: preprocessing, magnifier, scale bar, ghosts, landscape, space. */
import assert from 'node:assert/strict';
import { drawn, IN_FIREFOX, pageTest, screenshot, step, until } from './support/browser.mjs';
import { choose } from './support/files.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { demoFile, trueOutline, truePose } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */

pageTest('seeing', async (page, t) => {
  const stage = new Stage(page);
  await panel.openDemonstration(page);
  await panel.waitForLibraries(page, 'Femur', 'Tibia');
  await choose(page, await demoFile('femur.jts'), await demoFile('tibia.jts'));
  await panel.waitForWords(page, /as poses of the (femur|tibia)/);
  await stage.learn();

  await step(page, t, 'the frame as it is, inverted, its edges, its contrast equalised', () => preprocessings(page, stage));
  await step(page, t, 'the model as an outline, filled, shaded', () => overlays(page, stage));
  await step(page, t, 'all of it in one sheet, with switches', () => sheet(page, stage));
  await step(page, t, 'the magnifier shows four times as much, beside the pointer', () => magnifier(page, stage));
  await step(page, t, 'the scale bar follows zoom and depth', () => scaleBar(page, stage));
  await step(page, t, 'outlines of the neighbouring frames', () => ghosts(page, stage));
  await step(page, t, 'the landscape of scores: read, walked through, taken from', (t) => landscape(page, stage, t));
  await step(page, t, 'the models in space, turned by keys', () => space(page));
  await step(page, t, 'the browser remembers', () => remembered(page));
});

if (!IN_FIREFOX) {
  pageTest('dark whatever the system asks for, until somebody chooses', async (page) => {
    const isShown = async (/** @type {'light' | 'dark'} */ theme) => {
      await page.emulateMedia({ colorScheme: 'light' });
      await page.reload();
      await page.locator(`html[data-theme=${theme}]`).waitFor();
      // The theme is there before the page listens to keys.
      await page.getByRole('button', { name: 'Open the demonstration' }).waitFor();
      await drawn(page);
    };
    await isShown('dark');
    await page.keyboard.press('Shift+L');
    await isShown('light');
    await page.keyboard.press('Shift+L');
    await isShown('dark');
  });
}

/** @param {Page} page @param {string} key */
async function press(page, key) {
  await page.getByRole('application', { name: /outline$/ }).focus();
  await page.keyboard.press(key);
  await drawn(page);
}

/** @param {Page} page @param {Stage} stage */
async function preprocessings(page, stage) {
  const original = await stage.picture();
  const seen = [original];
  const isOther = (/** @type {Buffer} */ picture) => seen.every((other) => !other.equals(picture));
  for (const [key, name] of /** @type {const} */ ([['2', 'inverted'], ['3', 'edges'], ['4', 'equalised']])) {
    await press(page, key);
    seen.push(await until(() => stage.picture(), isOther, `a frame that is ${name} to look like no other`));
    await screenshot(page, `frame ${name}`);
  }
  // Window and level work on these pictures too.
  await page.getByRole('slider', { name: 'Window width' }).fill('60');
  await stage.looksOtherwise(seen[3], 'a narrower window to change the equalised frame');
  await press(page, 'r');
  await press(page, '1');
  await stage.looksLike(original, 'the frame');
}

/** @param {Page} page @param {Stage} stage */
async function overlays(page, stage) {
  const fill = await stage.picture();
  await press(page, '5');
  const outline = await stage.looksOtherwise(fill, 'an outline to be no fill');
  await press(page, '7');
  await stage.looksOtherwise(outline, 'the shaded models');
  await screenshot(page, 'shaded');
  assert.doesNotMatch(await panel.said(page), /cannot be shown/);
  const shaded = await stage.picture();
  await page.keyboard.down(' ');
  await stage.looksOtherwise(shaded, 'Space to hide them while it is held');
  await page.keyboard.up(' ');
  await stage.looksLike(shaded, 'the shaded models');
  await press(page, '6');
  await stage.looksLike(fill, 'the fill');
}

/** @param {Page} page @param {Stage} stage */
async function sheet(page, stage) {
  const before = await stage.picture();
  await page.getByRole('button', { name: 'View', exact: true }).click();
  const view = page.getByRole('dialog', { name: 'View' });
  await view.getByRole('radio', { name: 'Original', checked: true }).waitFor();
  await view.getByRole('radio', { name: 'Inverted' }).click();
  await view.getByRole('radio', { name: 'Inverted', checked: true }).waitFor();
  await view.getByRole('radio', { name: 'Outline' }).click();
  const magnifier = view.getByRole('switch', { name: 'Magnifier' });
  await magnifier.click();
  await magnifier.and(page.getByRole('switch', { checked: true })).click();
  await magnifier.and(page.getByRole('switch', { checked: false })).waitFor();
  await screenshot(page, 'sheet view');
  await view.getByRole('radio', { name: 'Original' }).click();
  await view.getByRole('radio', { name: 'Fill' }).click();
  await page.keyboard.press('Escape');
  await view.waitFor({ state: 'hidden' });
  await stage.looksLike(before, 'the stage');
}

/** @param {Page} page @param {Stage} stage */
async function magnifier(page, stage) {
  const at = /** @type {import('./support/study.mjs').Point} */ ([430, 520]);
  const lens = await lensOf(page, stage, at);
  const without = await lens();
  await press(page, 'z');
  await stage.hover(at);
  const magnified = await until(lens, (picture) => !picture.equals(without), 'a lens beside the pointer');
  await screenshot(page, 'magnifier');
  await stage.hover([at[0] + 3, at[1]]);
  await until(lens, (picture) => !picture.equals(magnified), 'it to follow the pointer');
  await press(page, 'z');
  await stage.hover(at);
  await until(lens, (picture) => picture.equals(without), 'Z to take it away');
}

/** A picture of where the lens would be: above and to the right of a place. @param {Page} page @param {Stage} stage @param {import('./support/study.mjs').Point} at */
async function lensOf(page, stage, at) {
  await stage.hover(at);
  await drawn(page);
  const [x, y] = stage.toPage(at);
  return () => page.screenshot({ clip: { x: x + 45, y: y - 195, width: 140, height: 140 } });
}

/** @param {Page} page @param {Stage} stage */
async function scaleBar(page, stage) {
  const bar = page.getByRole('img', { name: /^Scale bar: \d+ mm at the femur$/ });
  await bar.waitFor();
  const millimetres = async () => Number(/(\d+) mm/.exec((await bar.getAttribute('aria-label')) ?? '')?.[1]);
  const width = async () => (await bar.boundingBox())?.width ?? 0;
  const { z } = await truePose('femur', 1);
  const [, distance, , , pitch] = (await demoFile('calibration.txt')).buffer.toString().trim().split(/\s+/).map(Number);
  const expected = (((await millimetres()) * distance) / pitch / -z) * stage.view.scale;
  // The middle of the model is some cm from its origin; the border is drawn too.
  assert(Math.abs((await width()) / expected - 1) < 0.06, `${await width()} px for ${await millimetres()} mm, ${expected} expected`);
  const perMillimetre = (await width()) / (await millimetres());
  await stage.hover([500, 500]);
  for (let notch = 0; notch < 3; notch++) await page.mouse.wheel(0, -100);
  await drawn(page);
  const zoomed = (await width()) / (await millimetres());
  assert(Math.abs(zoomed / perMillimetre - 2) < 0.08, `${zoomed / perMillimetre} times as long after zooming twice as near`);
  await press(page, '8');
  await bar.waitFor({ state: 'detached' });
  await press(page, '8');
  await press(page, '0');
}

/** @param {Page} page @param {Stage} stage */
async function ghosts(page, stage) {
  await press(page, 'f');
  await press(page, 'p');
  for (const corner of /** @type {import('./support/study.mjs').Point[]} */ ([[200, 200], [320, 200], [260, 320]])) await stage.click(corner);
  await press(page, 'd');
  const without = await stage.picture();
  await press(page, 'g');
  await stage.looksOtherwise(without, 'the outline of the next frame');
  await screenshot(page, 'ghosts');
  await press(page, 'g');
  await stage.looksLike(without, 'the frame alone');
}

/** @param {Page} page @param {Stage} stage @param {import('node:test').TestContext} t */
async function landscape(page, stage, t) {
  await press(page, 'p');
  await stage.trace(await trueOutline('femur', 1));
  await panel.waitForPose(page);
  await page.getByRole('radio', { name: 'Landscape' }).click();
  const region = page.getByRole('region', { name: 'Score landscape' });
  const grid = region.getByRole('application', { name: /^Scores of the library’s views\. x \S+°, y \S+°: \d[\d\s]* px unmatched$/ });
  await grid.waitFor();
  const best = (await grid.getAttribute('aria-label')) ?? '';
  t.diagnostic(`${best}; ${await region.innerText()}`);
  await region.getByText(/^best at x .+ px unmatched, bright to dark$/).waitFor();
  await screenshot(page, 'landscape');
  await grid.focus();
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowDown');
  const beside = await until(async () => (await grid.getAttribute('aria-label')) ?? '', (name) => name !== best, 'another view');
  assert(unmatchedIn(beside) > unmatchedIn(best), `${beside} beside ${best}`);
  const before = await panel.waitForPose(page);
  await page.keyboard.press('Enter');
  await page.getByRole('radio', { name: 'View candidate', checked: true }).waitFor();
  const taken = await panel.waitForOtherPose(page, before);
  // A step of the library is 2.5 degrees, and the best view itself is up to one beside the pose.
  assert(Math.abs(taken.xRot - before.xRot) < 5 && Math.abs(taken.yRot - before.yRot) < 5, `a view nearby is a pose nearby: ${panel.differences(taken, before)}, from ${best} to ${beside}`);
  await page.keyboard.press('Control+z');
  await panel.waitForThePose(page, before);
  // By mouse: a corner of the grid.
  const box = await grid.boundingBox();
  assert(box);
  await page.mouse.click(box.x + 3, box.y + 3);
  await page.getByRole('radio', { name: 'View candidate', checked: true }).waitFor();
  await page.keyboard.press('Control+z');
  await panel.waitForThePose(page, before);
}

/** @param {string} name */
function unmatchedIn(name) {
  return Number(/(\d+) px/.exec(name.replace(/[\s\u202f](?=\d{3})/g, ''))?.[1]);
}

/** @param {Page} page */
async function space(page) {
  await page.getByRole('radio', { name: '3-D' }).click();
  const region = page.getByRole('region', { name: 'Models in space' });
  const canvas = region.getByRole('application', { name: /^Femur and Tibia in space/ });
  await canvas.waitFor();
  await region.getByRole('button', { name: 'Side', exact: true }).and(page.locator(':enabled')).waitFor();
  const look = async () => (await drawn(page), canvas.screenshot());
  const blank = await look();
  await region.getByRole('button', { name: 'Side', exact: true }).click();
  const side = await until(look, (picture) => !picture.equals(blank), 'another side');
  await canvas.focus();
  await page.keyboard.press('ArrowRight');
  const turned = await until(look, (picture) => !picture.equals(side), 'the models to turn');
  await page.keyboard.press('ArrowUp');
  await until(look, (picture) => !picture.equals(turned), 'the models to turn up');
  await region.getByRole('button', { name: 'Camera' }).click();
  await drawn(page);
  await screenshot(page, 'space');
  await besideTheFrame(page, region, canvas);
}

/** As large as the frame, which keeps its place. @param {Page} page @param {import('playwright-core').Locator} region @param {import('playwright-core').Locator} canvas */
async function besideTheFrame(page, region, canvas) {
  const stage = page.getByRole('main');
  const before = await stage.boundingBox();
  const beside = region.getByRole('button', { name: 'Beside the frame' });
  await beside.click();
  await drawn(page);
  const [frame, models] = [await stage.boundingBox(), await canvas.boundingBox()];
  assert(before && frame && models);
  assert(models.x >= frame.x + frame.width - 1 && Math.abs(models.width - frame.width) < 8 && Math.abs(models.height - frame.height) < 8, JSON.stringify({ frame, models }));
  assert(models.x + models.width <= before.x + before.width + 1, 'it covers nothing else');
  await screenshot(page, 'space-large');
  await beside.click();
  await drawn(page);
  assert.deepEqual(await stage.boundingBox(), before);
}

/** @param {Page} page */
async function remembered(page) {
  await press(page, '3');
  await press(page, '5');
  const taste = () => page.evaluate(() => localStorage.getItem('fluoropose-taste'));
  await until(taste, (text) => /"preprocessing":"edges"/.test(text ?? ''), 'the taste to be kept');
  page.once('dialog', (dialog) => dialog.accept());
  await page.reload();
  await page.getByRole('application', { name: /outline$|No frame/ }).first().waitFor();
  await page.getByRole('button', { name: 'View', exact: true }).click();
  const view = page.getByRole('dialog', { name: 'View' });
  await view.getByRole('radio', { name: 'Edges', checked: true }).waitFor();
  await view.getByRole('radio', { name: 'Outline', checked: true }).waitFor();
}
