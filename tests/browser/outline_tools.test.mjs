/** Tools that change an outline: brush, stretches, the whole outline moved, turned, scaled, taken to the next frame. */
import assert from 'node:assert/strict';
import { drawn, pageTest, screenshot, step, until } from './support/browser.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { trueOutline, truePose } from './support/study.mjs';
import * as tracing from './support/tracing.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./support/study.mjs').Point} Point */

pageTest('brush, stretches and whole outlines', async (page, t) => {
  const stage = new Stage(page);
  await tracing.openDemonstration(page);
  await stage.learn();
  const outline = await trueOutline('femur', 1);
  await page.keyboard.press('p');
  await stage.trace(outline);
  await panel.waitForPose(page);
  await step(page, t, 'brush: adds, with Alt erases; one stroke is one unit of undo', () => brush(page, stage, outline));
  await step(page, t, 'a stretch is marked unknown by dragging along it, and known again', () => stretch(page, stage, outline));
  await step(page, t, 'the outline moves, turns and scales by its handles and by keys', () => transform(page, stage));
  await step(page, t, 'the next frame takes it over', (t) => copy(page, t));
});

/** @param {Page} page @param {Stage} stage @param {Point[]} outline */
async function brush(page, stage, outline) {
  const pose = await panel.waitForPose(page);
  const lowest = outline.reduce((low, point) => (point[1] > low[1] ? point : low));
  const [column, row] = lowest;
  await page.keyboard.press('b');
  await tracing.toolInHand(page, 'Brush');
  await stage.drag([column - 20, row + 4], [column + 20, row + 4]);
  const fatter = await panel.waitForOtherPose(page, pose);
  await screenshot(page, 'brush');
  await page.keyboard.down('Alt');
  await stage.drag([column - 40, row + 10], [column + 40, row + 10]);
  await page.keyboard.up('Alt');
  const undo = page.getByRole('button', { name: 'Undo: erase from the outline' });
  await undo.click();
  await panel.waitForThePose(page, fatter);
  await page.getByRole('button', { name: 'Undo: paint on the outline' }).click();
  await panel.waitForThePose(page, pose);
  const radius = () => panel.slider(page, 'Brush radius');
  const before = await radius();
  await page.keyboard.press(']');
  await until(radius, (now) => now > before, 'a larger brush');
  await page.keyboard.press('e');
  await tracing.strip(page).getByRole('radio', { name: 'Erase', checked: true }).waitFor();
  await page.keyboard.press('e');
}

/** @param {Page} page @param {Stage} stage @param {Point[]} outline */
async function stretch(page, stage, outline) {
  const way = tracing.alongRing(outline, 8).slice(3, 20);
  await page.getByRole('button', { name: 'Mark a stretch unknown' }).click();
  await dragAlong(page, stage, way);
  await page.getByRole('button', { name: 'Undo: mark a stretch unknown' }).waitFor();
  await drawn(page);
  await screenshot(page, 'stretch');
  await dragAlong(page, stage, way.slice(2, -2));
  await page.getByRole('button', { name: 'Undo: mark a stretch known' }).waitFor();
  await tracing.strip(page).getByRole('button', { name: 'All known' }).click();
  await page.getByRole('button', { name: 'Undo: mark all of the outline known' }).waitFor();
  for (let step = 0; step < 3; step++) await page.keyboard.press('Control+z');
}

/** @param {Page} page @param {Stage} stage @param {Point[]} way */
async function dragAlong(page, stage, way) {
  await stage.hover(way[0]);
  await page.mouse.down();
  for (const point of way.slice(1)) await stage.hover(point);
  await page.mouse.up();
}

/** @param {Page} page @param {Stage} stage */
async function transform(page, stage) {
  const pose = await panel.waitForPose(page);
  const outline = await trueOutline('femur', 1);
  const inside = tracing.insideOf(outline);
  await page.keyboard.press('m');
  await stage.hover(inside);
  await drawn(page);
  await screenshot(page, 'transform');
  await stage.drag(inside, [inside[0] + 12, inside[1] - 8]);
  await page.getByRole('button', { name: 'Undo: move the outline' }).waitFor();
  const moved = await panel.waitForOtherPose(page, pose);
  assert(moved.x > pose.x + 1 && moved.y > pose.y + 1, `${JSON.stringify(moved)} lies right and above of ${JSON.stringify(pose)}`);
  await page.keyboard.press('Control+z');
  await panel.waitForThePose(page, pose);
  for (let turn = 0; turn < 3; turn++) await page.keyboard.press('Control+ArrowRight');
  const turned = await panel.waitForOtherPose(page, pose);
  assert(Math.abs(turned.zRot - pose.zRot + 3) < 0.6, `3 degrees clockwise: ${pose.zRot} became ${turned.zRot}`);
  await page.keyboard.press('Control+z');
  await panel.waitForThePose(page, pose);
  const [left, top] = [0, 1].map((axis) => Math.min(...outline.map((point) => point[axis])));
  await stage.drag([left, top], [left - 20, top - 20]);
  const larger = await panel.waitForOtherPose(page, pose);
  assert(larger.z > pose.z + 5, `larger is nearer: ${pose.z} became ${larger.z}`);
  await page.getByRole('button', { name: 'Undo: scale the outline' }).click();
  await panel.waitForThePose(page, pose);
}

/** @param {Page} page @param {import('node:test').TestContext} t */
async function copy(page, t) {
  await page.keyboard.press('f');
  await page.keyboard.press('Shift+D');
  await panel.waitForWords(page, /^The outline of frame 1 was copied/);
  await page.getByRole('button', { name: 'Undo: copy the outline of frame 1' }).waitFor();
  const before = await panel.waitForPose(page);
  await page.keyboard.press('s');
  await panel.waitForWords(page, /^Snapped to the edges/);
  const after = await tracing.corrected(page);
  t.diagnostic(`copied and snapped: ${panel.differences(after, await truePose('femur', 2))}`);
  await tracing.waitForCell(page, /^Frame 2, femur: posed/);
  await page.keyboard.press('d');
}
