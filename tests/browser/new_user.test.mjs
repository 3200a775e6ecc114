/** From the empty page to a refined pose, by one click and by a plain polygon; clicks counted (seconds: `cargo xtask bench --browser`). Fingers on the frame. */
import assert from 'node:assert/strict';
import { atRest, pageTest, screenshot, step, until } from './support/browser.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { truePose } from './support/study.mjs';
import * as tracing from './support/tracing.mjs';

/** @typedef {import('playwright-core').Page} Page */

/** From opening the page to a refined pose of the femur. */
const MOST_CLICKS = 12;
const MOST_CLICKS_OF_A_POLYGON = 40;

/** Some thirty clicks, each up to 2.5 px off. */
const QUICK = { x: 0.6, y: 0.6, z: 12, zRot: 1.2, xRot: 1.5, yRot: 1.5 };

pageTest('a new user with one click', async (page, t) => {
  const { clicks, seconds, pose } = await timed(page, async () => {
    await tracing.openDemonstration(page);
    return tracing.byOneClick(page);
  });
  const truth = await truePose('femur', 1);
  t.diagnostic(`${clicks} clicks, ${seconds.toFixed(1)} s: ${panel.differences(pose, truth)}`);
  await screenshot(page, 'one click');
  panel.assertNear(pose, truth, tracing.BY_ONE_CLICK);
  assert(clicks < MOST_CLICKS, `${clicks} clicks`);
  assert((await panel.cells(page)).includes('Frame 1, femur: posed'));
  assert.equal(await panel.verdict(page), 'Good');
  // What the film tells of the pose may have come meanwhile.
  await atRest(page);
  const settled = await panel.shownPose(page);
  assert(settled, 'the pose stays');
  await page.getByRole('button', { name: 'Undo: outline by one click' }).click();
  await until(() => panel.shownPose(page), (shown) => shown === null, 'outline and pose to be gone together');
  await page.keyboard.press('Control+y');
  await panel.waitForThePose(page, settled);
  await withTheOther(page, t);
});

/** The film that both components tell corrects the pose that was there. @param {Page} page @param {import('node:test').TestContext} t */
async function withTheOther(page, t) {
  const film = page.getByRole('region', { name: 'Film' });
  await film.getByText(/^Logarithmic film, \d\d grey values for a factor of e, blur 0\.\d px\.$/).waitFor();
  // The femur's own pose follows from that first.
  await atRest(page);
  await page.getByRole('radio', { name: 'Tibia' }).click();
  const tibia = await tracing.byOneClick(page, 'tibia');
  await film.getByText(/^Logarithmic film, 4\d grey values for a factor of e, blur 0\.\d px\.$/).waitFor();
  t.diagnostic(`tibia: ${panel.differences(tibia, await truePose('tibia', 1))}`);
  panel.assertNear(tibia, await truePose('tibia', 1), tracing.BY_TWO_CLICKS);
  const shown = await panel.deviations(page);
  await page.getByRole('radio', { name: 'Femur' }).click();
  await panel.waitForOtherPose(page, tibia);
  const femur = await panel.waitForPose(page);
  t.diagnostic(`femur: ${panel.differences(femur, await truePose('femur', 1))}; z +-${(await panel.deviations(page)).z}, tibia +-${shown.z}`);
  panel.assertNear(femur, await truePose('femur', 1), tracing.BY_TWO_CLICKS);
  await stated(page);
}

/** A person knows better: the display is linear. @param {Page} page */
async function stated(page) {
  const before = await panel.waitForPose(page);
  await page.getByRole('region', { name: 'Film' }).getByRole('button', { name: 'Film' }).click();
  const sheet = page.getByRole('dialog', { name: 'Film' });
  await sheet.getByRole('radiogroup', { name: 'Display' }).getByRole('radio', { name: 'Linear' }).click();
  await sheet.getByText(/^Linear film, as stated, blur/).waitFor();
  const linear = await panel.waitForOtherPose(page, before);
  assert(linear.z < before.z - 2, `${linear.z} mm by a linear display`);
  await sheet.getByRole('spinbutton', { name: 'Blur (px)' }).fill('13');
  await sheet.getByRole('alert').getByText('A blur is above 0 and at most 12 pixels.').waitFor();
  await page.keyboard.press('Escape');
}

pageTest('a new user with a plain polygon', async (page, t) => {
  const { clicks, seconds, pose } = await timed(page, async () => {
    await tracing.openDemonstration(page);
    return tracing.byPolygon(page);
  });
  const truth = await truePose('femur', 1);
  t.diagnostic(`${clicks} clicks, ${seconds.toFixed(1)} s: ${panel.differences(pose, truth)}`);
  panel.assertNear(pose, truth, QUICK);
  assert(clicks < MOST_CLICKS_OF_A_POLYGON, `${clicks} clicks`);
  await step(page, t, 'fingers zoom and move the frame', async () => {
    await page.keyboard.press('Shift+Delete');
    await until(() => panel.shownPose(page), (shown) => shown === null, 'the frame to be as it was opened');
    await page.keyboard.press('o');
    await page.keyboard.press('0');
    const stage = new Stage(page);
    await stage.learn();
    await pinch(page, stage);
  });
});

/** Presses and seconds of a way through the page. @param {Page} page @param {() => Promise<import('./support/study.mjs').Pose>} way */
async function timed(page, way) {
  const clicks = await tracing.countClicks(page);
  const startedAt = Date.now();
  const pose = await way();
  return { pose, clicks: await clicks(), seconds: (Date.now() - startedAt) / 1000 };
}

/** @param {Page} page @param {Stage} stage */
async function pinch(page, stage) {
  const session = await page.context().newCDPSession(page);
  const touch = (/** @type {string} */ type, /** @type {number[][]} */ points) =>
    session.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const [x, y] = stage.toPage([500, 500]);
  const { scale } = stage.view;
  await touch('touchStart', [[x - 40, y]]);
  await touch('touchStart', [[x - 40, y], [x + 40, y]]);
  for (let step = 1; step <= 8; step++) await touch('touchMove', [[x - 40 - 5 * step, y], [x + 40 + 5 * step, y]]);
  await touch('touchEnd', []);
  await stage.learn();
  assert(Math.abs(stage.view.scale / scale - 2) < 0.1, `two fingers twice as far apart zoom ${stage.view.scale / scale} times`);
  assert.equal((await panel.cells(page)).find((cell) => /^Frame 1, femur/.test(cell)), 'Frame 1, femur: empty', 'the first finger drew nothing');
  await page.keyboard.press('0');
  await page.keyboard.press('p');
  await stage.learn();
  await touch('touchStart', [stage.toPage([400, 300])]);
  await touch('touchEnd', []);
  await panel.waitForWords(page, /^1 point\./);
}
