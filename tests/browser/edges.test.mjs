/** Tools that find the edges themselves: threshold, live-wire, snap, and shaping what they found. */
import assert from 'node:assert/strict';
import { drawn, pageTest, says, screenshot, step, until } from './support/browser.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { polygonWithin, trueOutline, truePose } from './support/study.mjs';
import * as tracing from './support/tracing.mjs';

/** @typedef {import('playwright-core').Page} Page */

pageTest('threshold, live-wire and snap', async (page, t) => {
  const stage = new Stage(page);
  await tracing.openDemonstration(page);
  await stage.learn();
  await step(page, t, 'threshold: a click inside takes the region, its level can be moved', (t) => threshold(page, stage, t));
  await step(page, t, 'live-wire: the path follows the edge, Backspace and undo take it back', (t) => liveWire(page, stage, t));
  await step(page, t, 'one click', () => oneClick(page));
  await step(page, t, 'snap: a rough outline comes to the edges', (t) => snap(page, stage, t));
  await step(page, t, 'shape: simplified with its error shown', () => shape(page));
  await step(page, t, 'both components by a tool are as near as by two clicks', (t) => both(page, stage, t));
});

/** @param {Page} page @param {Stage} stage @param {import('node:test').TestContext} t */
async function threshold(page, stage, t) {
  const inside = tracing.insideOf(await trueOutline('femur', 1));
  await page.getByRole('button', { name: 'Threshold', exact: true }).click();
  await tracing.toolInHand(page, 'Threshold');
  await stage.hover(inside);
  await drawn(page);
  await screenshot(page, 'threshold hover');
  await stage.click(inside);
  const pose = await tracing.corrected(page);
  const truth = await truePose('femur', 1);
  t.diagnostic(`threshold: ${panel.differences(pose, truth)}`);
  panel.assertNear(pose, truth, tracing.BY_ONE_CLICK);
  await page.getByRole('region', { name: 'Pose numbers' }).getByText(/refined on the frame by its film, .* from an outline that a tool laid/).waitFor();
  await screenshot(page, 'threshold taken');
  // The region is where it was, and can be adjusted.
  const level = () => panel.slider(page, 'Threshold level');
  const before = await level();
  for (let turn = 0; turn < 3; turn++) await page.keyboard.press('[');
  await until(level, (now) => now < before, 'a lower level');
  await panel.waitForOtherPose(page, pose);
  await page.getByRole('button', { name: 'Undo: take a region' }).click();
  await until(() => panel.shownPose(page), (shown) => shown === null, 'level and region to be undone at once');
  await page.keyboard.press('Control+y');
  await page.keyboard.press('Shift+Delete');
}

/** @param {Page} page @param {Stage} stage @param {import('node:test').TestContext} t */
async function liveWire(page, stage, t) {
  // Whatever the step before left.
  await page.keyboard.press('Shift+Delete');
  const outline = await trueOutline('femur', 1);
  const way = tracing.alongRing(outline, 12);
  await page.keyboard.press('l');
  await tracing.toolInHand(page, 'Live-wire');
  for (const [index, point] of way.slice(0, 26).entries()) {
    if (index % 12 === 0) await stage.click(point);
    else await stage.hover(point);
  }
  await drawn(page);
  await screenshot(page, 'live-wire draft');
  // Three clicks: the beginning and two stretches; what cooled in between is taken back alike.
  const undo = (/** @type {string} */ label) => page.getByRole('button', { name: `Undo: ${label}` }).waitFor();
  await undo('follow the edge');
  await page.keyboard.press('Backspace');
  await undo('take a stretch back');
  await page.keyboard.press('Control+z');
  await undo('follow the edge');
  while ((await page.getByRole('button', { name: 'Undo: follow the edge' }).count()) > 0) {
    await page.keyboard.press('Control+z');
    await drawn(page);
  }
  await undo('begin the outline');
  await page.keyboard.press('Shift+Delete');
  await tracing.wireRound(page, stage, outline, 9);
  const pose = await tracing.corrected(page);
  const truth = await truePose('femur', 1);
  t.diagnostic(`live-wire: ${panel.differences(pose, truth)}`);
  await screenshot(page, 'live-wire closed');
  panel.assertNear(pose, truth, tracing.BY_ONE_CLICK);
  await page.keyboard.press('Shift+Delete');
}

/** The tool that `new_user.test.mjs` begins with, here beside the others. @param {Page} page */
async function oneClick(page) {
  panel.assertNear(await tracing.byOneClick(page), await truePose('femur', 1), tracing.BY_ONE_CLICK);
  await page.getByRole('button', { name: 'Undo: outline by one click' }).click();
  await until(() => panel.shownPose(page), (shown) => shown === null, 'outline and pose to be gone together');
}

/** @param {Page} page @param {Stage} stage @param {import('node:test').TestContext} t */
async function snap(page, stage, t) {
  await page.keyboard.press('Shift+Delete');
  const rough = await polygonWithin('femur', 1, 4);
  await page.keyboard.press('p');
  await stage.trace(rough);
  const before = await panel.waitForPose(page);
  await page.keyboard.press('s');
  await panel.waitForWords(page, /^Snapped to the edges/);
  await panel.waitForOtherPose(page, before);
  const after = await tracing.corrected(page);
  const truth = await truePose('femur', 1);
  t.diagnostic(`${rough.length} points, before: ${panel.differences(before, truth)}; after: ${panel.differences(after, truth)}`);
  await screenshot(page, 'snapped');
  panel.assertNear(after, truth, tracing.BY_ONE_CLICK);
  await page.getByRole('button', { name: 'Undo: snap the outline' }).click();
  await panel.waitForThePose(page, before);
  await page.keyboard.press('Control+y');
  await panel.waitForThePose(page, after);
}

/** @param {Page} page */
async function shape(page) {
  // What was redone before is on the film once more.
  const pose = await tracing.corrected(page);
  await tracing.strip(page).getByRole('button', { name: 'Shape the outline' }).click();
  const sheet = page.getByRole('dialog', { name: 'Shape' });
  await sheet.getByRole('slider', { name: 'Simplify within' }).fill('2');
  const text = await says(sheet, /\d+ points become \d+\. The shape moves by [\d.]+ px at most/);
  const [, before, after, greatest] = /(\d+) points become (\d+)\. The shape moves by ([\d.]+) px/.exec(text) ?? [];
  assert(Number(after) < Number(before) && Number(greatest) <= 2, text);
  await screenshot(page, 'shape sheet');
  await sheet.getByRole('button', { name: 'Use this shape' }).click();
  await sheet.waitFor({ state: 'hidden' });
  await page.getByRole('button', { name: 'Undo: simplify the outline' }).waitFor();
  await panel.waitForOtherPose(page, pose);
  await page.keyboard.press('Shift+S');
  await sheet.getByRole('slider', { name: 'Smooth over' }).fill('4');
  await page.keyboard.press('Escape');
  await sheet.waitFor({ state: 'hidden' });
  await page.getByRole('button', { name: 'Undo: simplify the outline' }).waitFor();
  await page.keyboard.press('Control+z');
  await page.getByRole('button', { name: 'Redo: simplify the outline' }).waitFor();
  // The outline is what it was; its pose is corrected by what the film has told since (seen: 0.8 mm of z).
  panel.assertNear(await tracing.corrected(page), pose, tracing.BY_TWO_CLICKS);
}

/** @param {Page} page @param {Stage} stage @param {import('node:test').TestContext} t */
async function both(page, stage, t) {
  await page.keyboard.press('Shift+Delete');
  await page.keyboard.press('t');
  for (const component of /** @type {const} */ (['femur', 'tibia'])) {
    await page.getByRole('radio', { name: component === 'femur' ? 'Femur' : 'Tibia' }).click();
    await stage.click(tracing.insideOf(await trueOutline(component, 1)));
    await tracing.corrected(page);
  }
  for (const component of /** @type {const} */ (['tibia', 'femur'])) {
    await page.getByRole('radio', { name: component === 'femur' ? 'Femur' : 'Tibia' }).click();
    const [pose, truth] = [await tracing.corrected(page), await truePose(component, 1)];
    t.diagnostic(`${component}: ${panel.differences(pose, truth)} ${await panel.verdict(page)}`);
    await screenshot(page, `by a tool ${component}`);
    panel.assertNear(pose, truth, tracing.BY_TWO_CLICKS);
  }
  await screenshot(page, 'both by a tool');
}
