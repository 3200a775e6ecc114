/** From an opened study to a checked film: one click into each component, Follow, and the doubtful poses one by one. */
import assert from 'node:assert/strict';
import { atRest, drawn, IN_FIREFOX, pageTest, screenshot, step, until } from './support/browser.mjs';
import { Calls, followedWithOtherConstants, PRESS } from './support/calls.mjs';
import { exported } from './support/exporting.mjs';
import { keepFollowed } from './support/followed.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { trueOutline, truePose } from './support/study.mjs';
import * as tracing from './support/tracing.mjs';

/** @typedef {import('playwright-core').Page} Page */

/** Of the demonstration: each stage of following has something to do. */
const FRAMES = 3;
/** So many have to be good for the constants of a film to be compared with them. */
const COMPARED = 4;
/** Frames that are looked at until a test goes on: the film is not done sooner than it looks. */
const LOOK_AT_FEW = { method: 'look', most: 6 };
/** The frame may have to be decoded; one call may be under way. */
const MOST_BEFORE_A_CLICK = 2;

if (!IN_FIREFOX) {
  pageTest('one click each, then the film', async (page, t) => {
    await tracing.openDemonstration(page, FRAMES);
    await step(page, t, 'one click is the tool in hand, and the card leads on', () => twoClicks(page));
    await step(page, t, 'cells fill while the film is followed, as one step back', () => followed(page, t));
    keepFollowed(await exported(page, 'Session', 'With images and models'), FRAMES);
    await step(page, t, 'a click beside the way leaves nothing to be followed once it is taken back', () => takenBack(page));
    await step(page, t, 'a click while it is followed is answered at once', () => clickedMeanwhile(page, t));
    await step(page, t, 'the tool in hand is in hand after a reload', async () => {
      await page.keyboard.press('b');
      await panel.waitUntilKept(page);
      await page.reload();
      await panel.waitForWords(page, /is back as it was at .*; undo begins anew here\./);
      await tracing.toolInHand(page, 'Brush');
    });
  });

  pageTest('a film that tells other constants than where it began is followed again, and a reload meanwhile loses nothing', async (page, t) => {
    await tracing.openDemonstration(page, COMPARED);
    await twoClicks(page);
    await followedWithOtherConstants(page);
    await page.keyboard.press('Shift+G');
    await panel.waitForJob(page, /^Following the film again/);
    await until(() => panel.cells(page), (cells) => cells.every((cell) => /: (posed|followed)/.test(cell)), 'every cell to keep what was found first');
    await screenshot(page, 'followed again');
    await panel.waitUntilKept(page);
    const before = await panel.cells(page);
    await page.reload();
    await panel.waitForWords(page, /Following the film/);
    assert.deepEqual((await panel.cells(page)).map(withoutDoubt), before.map(withoutDoubt));
    for (const frame of [1, COMPARED]) {
      for (const component of /** @type {const} */ (['femur', 'tibia'])) await isTrue(page, t, component, frame);
      for (let shown = frame; shown < COMPARED; shown++) await page.keyboard.press('f');
    }
  });

  pageTest('a component that nobody clicked is looked for', async (page, t) => {
    await tracing.openDemonstration(page, FRAMES);
    await page.getByRole('radio', { name: 'Tibia' }).click();
    const stage = new Stage(page);
    const outline = await trueOutline('tibia', 1);
    await stage.zoomTo(outline);
    await stage.trace(outline);
    await panel.waitForPose(page);
    // Its mirror image is open while nothing is known of the femur.
    assert.match(await panel.verdict(page), /^Doubtful/);
    await page.keyboard.press('o');
    await step(page, t, 'a doubtful pose is looked at and accepted by keys', () => checked(page, t));
    const calls = await Calls.of(page, LOOK_AT_FEW);
    await page.keyboard.press('Shift+G');
    await panel.waitForJob(page, /^Looking for the femur (beside the tibia )?in frame \d: /);
    const found = await until(() => panel.cells(page), (cells) => cells.some((cell) => /femur: posed/.test(cell)), 'the femur to be found');
    t.diagnostic(found.find((cell) => /femur: posed/.test(cell)) ?? '');
    // The tibia is followed meanwhile, and may be quicker.
    const withOneMore = async () => {
      await calls.allow(1);
      return panel.cells(page);
    };
    await until(withOneMore, (cells) => cells.some((cell) => /femur: followed so far/.test(cell)), 'it to be followed from there');
    await page.keyboard.press('Shift+G');
    await calls.letGo();
    const said = await panel.waitForWords(page, /^Stopped: \d+ poses? found/);
    const count = Number(/\d+/.exec(said)?.[0]);
    const posed = (/** @type {string[]} */ cells) => cells.filter((cell) => /: (followed|posed|checked)(,|$)/.test(cell)).length;
    await until(() => panel.cells(page), (cells) => posed(cells) === count, `${count} cells with a pose`);
    assert.equal((await panel.cells(page)).filter((cell) => /so far/.test(cell)).length, 0, 'nothing is left of what was not kept');
  });
}

/** Of a frame that is shown. @param {Page} page @param {import('node:test').TestContext} t @param {'femur' | 'tibia'} component @param {number} frame */
async function isTrue(page, t, component, frame) {
  await page.getByRole('radio', { name: component === 'femur' ? 'Femur' : 'Tibia' }).click();
  await atRest(page);
  const [pose, truth] = [await panel.waitForPose(page), await truePose(component, frame)];
  t.diagnostic(`${component} in frame ${frame}: ${panel.differences(pose, truth)}`);
  panel.assertNear(pose, truth, tracing.BY_TWO_CLICKS);
}

/** @param {Page} page */
function card(page) {
  return page.getByRole('region', { name: 'What to do next' });
}

/** @param {Page} page */
async function twoClicks(page) {
  await tracing.toolInHand(page, 'One click');
  await card(page).getByText('Click the femur').waitFor();
  const stage = new Stage(page);
  await stage.learn();
  await stage.click(tracing.insideOf(await trueOutline('femur', 1)));
  await card(page).getByText('Now the tibia').waitFor();
  // The femur is still being found, and tools outline what the card asks for.
  await page.keyboard.press('p');
  await page.getByRole('radio', { name: 'Tibia', checked: true }).waitFor();
  await page.keyboard.press('o');
  await stage.click(tracing.insideOf(await trueOutline('tibia', 1)));
  await card(page).getByRole('button', { name: 'Follow the film' }).waitFor();
  await atRest(page);
  const cells = await panel.cells(page);
  assert(cells.some((cell) => cell.startsWith('Frame 1, femur: posed')), cells.join('; '));
  assert(cells.some((cell) => cell.startsWith('Frame 1, tibia: posed')), cells.join('; '));
  await screenshot(page, 'first frame');
}

/** @param {Page} page @param {import('node:test').TestContext} t */
async function followed(page, t) {
  const count = (/** @type {readonly string[]} */ cells, /** @type {RegExp} */ pattern) => cells.filter((cell) => pattern.test(cell)).length;
  const calls = await Calls.of(page, LOOK_AT_FEW);
  await card(page).getByRole('button', { name: 'Follow the film' }).click();
  await until(() => panel.cells(page), (cells) => count(cells, /: followed so far/) > 0, 'cells to fill');
  await calls.letGo();
  const done = await until(() => panel.cells(page), (cells) => count(cells, /: followed(,|$)/) > 0, 'the film to be followed');
  t.diagnostic(done.join('; '));
  assert.equal(count(done, /: followed(,|$)/), 2 * (FRAMES - 1), done.join('; '));
  assert.equal(count(done, /so far/), 0);
  await atRest(page);
  await until(async () => page.workers().filter((worker) => /follow/.test(worker.url())).length, (count) => count === 0, 'what a film needed to be let go');
  await page.getByRole('radio', { name: 'Femur' }).click();
  for (let frame = 1; frame < FRAMES; frame++) await page.keyboard.press('f');
  await atRest(page);
  const [last, truth] = [await panel.waitForPose(page), await truePose('femur', FRAMES)];
  t.diagnostic(`the last: ${panel.differences(last, truth)}`);
  panel.assertNear(last, truth, tracing.BY_TWO_CLICKS);
  await page.keyboard.press('Control+z');
  await until(() => panel.cells(page), (cells) => count(cells, /: empty/) === 2 * (FRAMES - 1), 'all of it to be gone');
  await page.keyboard.press('Control+y');
  await waitForFollowed(page, 2 * (FRAMES - 1));
}

/** The click tells the film a little more, which moves what was clicked before, there and back. @param {Page} page */
async function takenBack(page) {
  const stage = new Stage(page);
  await stage.learn();
  await stage.click(tracing.insideOf(await trueOutline('femur', FRAMES)));
  const follow = card(page).getByRole('button', { name: 'Follow the film' });
  await follow.waitFor();
  await atRest(page);
  await page.keyboard.press('Control+z');
  await waitForFollowed(page, 2 * (FRAMES - 1));
  await follow.waitFor({ state: 'hidden' });
  await atRest(page);
  assert.equal(await follow.count(), 0, await panel.cells(page).then((cells) => cells.join('; ')));
}

/** Nothing of the film goes before a click: the worker that finds poses gets it next, and answers before the film is followed. @param {Page} page @param {import('node:test').TestContext} t */
async function clickedMeanwhile(page, t) {
  await page.keyboard.press('Control+z');
  await until(() => panel.cells(page), (cells) => cells.filter((cell) => /: empty/.test(cell)).length === 2 * (FRAMES - 1), 'all of it to be gone');
  const stage = new Stage(page);
  await stage.learn();
  const isPosed = (/** @type {readonly string[]} */ cells) => cells.some((cell) => cell.startsWith(`Frame ${FRAMES}, femur: posed`));
  // What follows the film waits for its frames: the click does not.
  const calls = await Calls.of(page, LOOK_AT_FEW);
  await page.keyboard.press('Shift+G');
  await until(() => panel.cells(page), (cells) => cells.some((cell) => /: followed so far/.test(cell)), 'cells to fill');
  await stage.click(tracing.insideOf(await trueOutline('femur', FRAMES)));
  await until(() => panel.cells(page), (cells) => isPosed(cells), 'the click to be answered');
  const seen = await calls.seen();
  const since = seen.slice(seen.lastIndexOf(PRESS) + 1);
  t.diagnostic(`calls from the click to its pose: ${since.join(', ')}`);
  assert(since.slice(0, 1 + MOST_BEFORE_A_CLICK).includes('oneClick'), since.join(', '));
  assert(await page.getByRole('progressbar', { name: /film/ }).count(), 'the film is still followed');
  await calls.letGo();
  await waitForFollowed(page, 2 * (FRAMES - 1) - 1);
  assert(isPosed(await panel.cells(page)), 'what a person set stays');
}

/** @param {string} cell */
function withoutDoubt(cell) {
  return cell.replace(/, doubtful$/, '');
}

/** @param {Page} page @param {number} count */
function waitForFollowed(page, count) {
  return until(() => panel.cells(page), (cells) => cells.filter((cell) => /: followed(,|$)/.test(cell)).length === count, `${count} cells to be followed`);
}

/**
 * In a narrow window too rivals stand side by side, what to do is in sight, and half of the film is not covered.
 *
 * @param {Page} page
 * @param {import('playwright-core').Locator} doubt
 * @param {import('playwright-core').Locator} rivals
 */
async function liesOnTheFilm(page, doubt, rivals) {
  const boxes = (/** @type {import('playwright-core').Locator} */ parts) => parts.evaluateAll((all) => all.map((part) => part.getBoundingClientRect().toJSON()));
  const [[stage], [whole], radios, buttons] = await Promise.all([page.getByRole('application', { name: /outline$/ }), doubt, rivals.getByRole('radio'), doubt.getByRole('button')].map(boxes));
  assert(whole.height < stage.height / 2, `the card is ${whole.height} px high on a film of ${stage.height}`);
  assert(radios.every(({ top }) => top === radios[0].top), 'one rival lies below another');
  for (const { top, bottom } of buttons) assert(top >= stage.top && bottom <= stage.bottom, `a button at ${top} to ${bottom} on a film to ${stage.bottom}`);
}

/** @param {Page} page @param {import('node:test').TestContext} t */
async function checked(page, t) {
  await card(page).getByRole('button', { name: 'Doubtful: look at it' }).click();
  const doubt = page.getByRole('region', { name: 'A doubtful pose' });
  await doubt.getByText(/^Doubtful 1 of \d+$/).waitFor();
  const rivals = doubt.getByRole('radiogroup', { name: 'Poses to choose from' });
  await until(() => rivals.getByRole('radio').count(), (count) => count >= 2, 'the worst to have a rival');
  await rivals.getByRole('radio', { name: /^Pose 1, chosen: no joint angles/ }).waitFor();
  await screenshot(page, 'check');
  await page.setViewportSize({ width: 1024, height: 700 });
  for (const part of ['.check-why', '.check-picture']) await doubt.locator(part).first().waitFor();
  await screenshot(page, 'check at 1024 x 700');
  await page.setViewportSize({ width: 700, height: 700 });
  await drawn(page);
  await liesOnTheFilm(page, doubt, rivals);
  await screenshot(page, 'check at 700 x 700');
  await page.setViewportSize({ width: 1440, height: 900 });
  // Without the side of the body nobody can tell rivals by their angles.
  await page.getByRole('combobox', { name: 'Side of the body' }).selectOption('side?');
  await doubt.getByText('Of which side is the knee?').waitFor();
  await doubt.getByRole('button', { name: 'left' }).click();
  await doubt.getByText('Of which side is the knee?').waitFor({ state: 'hidden' });
  const before = await panel.shownPose(page);
  assert(before);
  await page.keyboard.press('2');
  const taken = await panel.waitForOtherPose(page, before);
  t.diagnostic(`a rival taken: ${panel.differences(taken, before)}`);
  await page.keyboard.press('1');
  await panel.waitForThePose(page, before);
  // A sheet that is not about the pose takes no verdict of it.
  await page.keyboard.press('?');
  const sheet = page.getByRole('dialog');
  await sheet.waitFor();
  await page.keyboard.press('y');
  await sheet.press('Escape');
  await sheet.waitFor({ state: 'hidden' });
  assert(!(await panel.cells(page)).some((cell) => /checked/.test(cell)), 'nothing was accepted');
  await page.keyboard.press('y');
  await until(() => panel.cells(page), (cells) => cells.some((cell) => /checked/.test(cell)), 'the pose to be accepted');
  await doubt.waitFor({ state: 'hidden' });
}
