/** A model in hand: keys as in JointTrack, the mouse, typed numbers, locks, refining from there, another set of poses. */
import assert from 'node:assert/strict';
import { atRest, drawn, pageTest, screenshot, step, until } from './support/browser.mjs';
import { exported } from './support/exporting.mjs';
import { choose, drop } from './support/files.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { HAND_TRACED, demoFile, trueOutline, truePose } from './support/study.mjs';
import { BY_ONE_CLICK } from './support/tracing.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./support/study.mjs').Pose} Pose */
/** @typedef {import('./support/study.mjs').Point} Point */

const FIELDS = /** @type {const} */ ([
  ['x', 'x (mm)'],
  ['y', 'y (mm)'],
  ['z', 'z (mm)'],
  ['zRot', 'z rotation (degrees)'],
  ['xRot', 'x rotation (degrees)'],
  ['yRot', 'y rotation (degrees)'],
]);

pageTest('poses by hand', async (page, t) => {
  const stage = new Stage(page);
  const truth = await truePose('femur', 1);
  await panel.openDemonstration(page);
  await panel.waitForLibraries(page, 'Femur', 'Tibia');
  await choose(page, await demoFile('femur.jts'));
  await panel.waitForWords(page, /as poses of the femur/);

  await step(page, t, 'where a loaded pose fits the frame and where a moved one does not is shown', () => edges(page, stage));
  await step(page, t, 'arrows alone, with Ctrl and with Shift change the six numbers', () => nudges(page, stage));
  await step(page, t, 'fine and coarse steps, and steps that are typed', () => steps(page));
  await step(page, t, 'a lock holds a number against keys and mouse', () => locks(page, stage));
  await step(page, t, 'numbers are typed, and what is no number changes nothing', () => typed(page));
  await step(page, t, 'the mouse moves the model with it, the ring turns it', () => mouse(page, stage, truth));
  await step(page, t, 'all of it is undone, back to the loaded pose', () => undone(page));
  await step(page, t, 'without an outline the frame itself is refined against', (t) => onTheFrame(page, truth, t));
  await step(page, t, 'a traced outline does not take the place of the pose set by hand', () => outlineStays(page, stage));
  await step(page, t, 'refined from here onto the outline, with a number held', (t) => onTheOutline(page, truth, t));
  await step(page, t, 'Q compares with the loaded poses', () => compares(page));
  await step(page, t, 'a session keeps the pose set by hand', () => session(page));
  await step(page, t, 'back to the pose of the outline', (t) => dropped(page, truth, t));
  await step(page, t, 'a model without a pose is placed, a double click takes it in hand', () => placed(page, stage));
});

/** The numbers while they can be typed. @param {Page} page @returns {Promise<Pose>} */
async function numbers(page) {
  await drawn(page);
  const card = page.getByRole('region', { name: 'Pose numbers' });
  const entries = FIELDS.map(async ([field, name]) => [field, Number(await card.getByRole('spinbutton', { name, exact: true }).inputValue())]);
  return /** @type {Pose} */ (Object.fromEntries(await Promise.all(entries)));
}

/** @param {Page} page @param {Stage} stage */
async function takeInHand(page, stage) {
  await stage.canvas.focus();
  await page.keyboard.press('a');
  await page.getByRole('button', { name: 'Refine from here' }).waitFor();
}

/** @param {Page} page @param {Stage} stage */
async function edges(page, stage) {
  const fitting = await onEdges(page, (percent) => percent > 90);
  await takeInHand(page, stage);
  for (let key = 0; key < 3; key++) await page.keyboard.press('ArrowRight');
  const moved = await onEdges(page, (percent) => percent < fitting - 20);
  for (let key = 0; key < 3; key++) await page.keyboard.press('ArrowLeft');
  await onEdges(page, (percent) => percent === fitting);
  assert(moved > 0, 'edges along which it was moved are met');
}

/** The part of the outline on edges as the panel tells it, once it is as asked. @param {Page} page @param {(percent: number) => boolean} isRight */
async function onEdges(page, isRight) {
  const region = page.getByRole('region', { name: 'Edges along the outline' });
  const read = async () => Number(/^(\d+) % of the outline/m.exec(await region.innerText())?.[1] ?? NaN);
  return until(read, isRight, 'edges along the outline');
}

/** @param {Page} page @param {Stage} stage */
async function nudges(page, stage) {
  await takeInHand(page, stage);
  for (const [keys, field, by] of /** @type {const} */ ([
    ['ArrowRight', 'x', 1],
    ['ArrowDown', 'y', -1],
    ['Control+ArrowUp', 'z', 10],
    ['Control+ArrowLeft', 'zRot', 1],
    ['Shift+ArrowDown', 'xRot', 1],
    ['Shift+ArrowRight', 'yRot', 1],
  ])) {
    const before = await numbers(page);
    await page.keyboard.press(keys);
    const after = await numbers(page);
    assert(Math.abs(after[field] - before[field] - by) < 0.021, `${keys}: ${field} from ${before[field]} to ${after[field]}`);
    const angles = /** @type {const} */ (['zRot', 'xRot', 'yRot']);
    for (const other of angles) if (other !== field) assert.equal(after[other], before[other], `${keys} leaves ${other}`);
  }
  await byHand(page).waitFor();
  await screenshot(page, 'hand');
}

/** @param {Page} page */
async function steps(page) {
  await page.keyboard.press('-');
  await panel.waitForWords(page, /^Fine steps: 0\.1 mm in the plane, 1 mm in depth, 0\.1°/);
  const before = await numbers(page);
  await page.keyboard.press('ArrowLeft');
  const fine = await numbers(page);
  assert(Math.abs(before.x - fine.x - 0.1) < 0.011, `fine: from ${before.x} to ${fine.x}`);
  await page.getByRole('spinbutton', { name: 'Fine step in the plane (mm)' }).fill('0.25');
  await page.getByRole('spinbutton', { name: 'Fine step in the plane (mm)' }).press('Enter');
  await page.getByRole('application', { name: /outline$/ }).focus();
  await page.keyboard.press('ArrowLeft');
  const own = await numbers(page);
  assert(Math.abs(fine.x - own.x - 0.25) < 0.011, `a typed step: from ${fine.x} to ${own.x}`);
  await page.keyboard.press('+');
  await page.getByRole('radio', { name: 'Coarse', checked: true }).waitFor();
}

/** @param {Page} page @param {Stage} stage */
async function locks(page, stage) {
  await page.getByRole('button', { name: 'Lock y', exact: true }).click();
  await page.getByRole('button', { name: 'Lock z rotation' }).click();
  await stage.canvas.focus();
  const before = await numbers(page);
  await page.keyboard.press('ArrowUp');
  await panel.waitForWords(page, /^y is locked/);
  await page.keyboard.press('Control+ArrowLeft');
  await panel.waitForWords(page, /^z rotation is locked/);
  await stage.learn();
  await stage.drag([200, 200], [260, 260]);
  const after = await numbers(page);
  assert.deepEqual([after.y, after.zRot], [before.y, before.zRot]);
  assert(after.x > before.x + 1, `x went from ${before.x} to ${after.x}`);
  for (const name of ['Lock y', 'Lock z rotation']) await page.getByRole('button', { name, exact: true }).click();
}

/** @param {Page} page */
async function typed(page) {
  const x = page.getByRole('spinbutton', { name: 'x (mm)', exact: true });
  await x.fill('12.5');
  await x.press('Enter');
  await until(() => numbers(page), ({ x }) => x === 12.5, 'the x that was typed');
  await x.press('ArrowUp');
  await until(() => numbers(page), ({ x }) => x === 13.5, 'an x of one more');
  const z = page.getByRole('spinbutton', { name: 'z (mm)', exact: true });
  const before = await numbers(page);
  await z.fill('20');
  await z.press('Enter');
  await panel.waitForWords(page, /^z has to be negative/);
  await page.getByRole('application', { name: /outline$/ }).focus();
  assert.equal((await numbers(page)).x, before.x);
}

/** @param {Page} page @param {Stage} stage @param {Pose} truth */
async function mouse(page, stage, truth) {
  await stage.learn();
  const focal = await focalLength();
  const before = await numbers(page);
  await stage.drag([200, 200], [280, 160]);
  const after = await numbers(page);
  // So many mm are a pixel where the model is; its middle is some cm nearer or farther than its origin.
  const perPixel = -before.z / focal;
  assert(Math.abs((after.x - before.x) / (80 * perPixel) - 1) < 0.06, `x by ${after.x - before.x}, ${80 * perPixel} expected`);
  assert(Math.abs((after.y - before.y) / (40 * perPixel) - 1) < 0.06, `y by ${after.y - before.y}, ${40 * perPixel} expected`);
  assert.equal(after.z, before.z);
  await page.keyboard.down('Shift');
  await stage.drag([200, 200], [260, 200]);
  await page.keyboard.up('Shift');
  const tilted = await numbers(page);
  assert(Math.abs(tilted.yRot - after.yRot) + Math.abs(tilted.xRot - after.xRot) > 3, 'Shift tilts');
  await page.keyboard.down('Control');
  await stage.drag([900, 500], [880, 380]);
  await page.keyboard.up('Control');
  const turned = await numbers(page);
  assert(Math.abs(turned.zRot - tilted.zRot) > 2, 'Ctrl turns');
  assert(Number.isFinite(truth.x));
}

/** @param {Page} page */
async function undone(page) {
  const loaded = () => page.getByText('From femur.jts.').count();
  await until(async () => {
    if ((await loaded()) === 0) await page.keyboard.press('Control+z');
    await drawn(page);
    return loaded();
  }, (count) => count > 0, 'the loaded pose');
  await page.keyboard.press('Control+y');
  await until(loaded, (count) => count === 0, 'redo to take the model in hand again');
  await page.keyboard.press('Control+z');
}

/** @param {Page} page @param {Pose} truth @param {import('node:test').TestContext} t */
async function onTheFrame(page, truth, t) {
  for (const keys of ['ArrowRight', 'ArrowUp', 'Control+ArrowLeft', 'Shift+ArrowUp', 'Shift+ArrowLeft']) await page.keyboard.press(keys);
  const off = await numbers(page);
  await page.keyboard.press('Enter');
  await panel.waitForWords(page, /^Refined from the pose set by hand, against the dark edges of the frame: \d+\.\d\d px\./);
  const found = await numbers(page);
  t.diagnostic(`from ${panel.differences(off, truth)} to ${panel.differences(found, truth)}; ${await panel.said(page)}`);
  // Poses of the femur alone tell the film, as one click does.
  panel.assertNear(found, truth, BY_ONE_CLICK);
}

/** @param {Page} page @param {Stage} stage */
async function outlineStays(page, stage) {
  for (const keys of ['ArrowRight', 'Shift+ArrowUp']) await page.keyboard.press(keys);
  const own = await numbers(page);
  await page.keyboard.press('p');
  await stage.learn();
  await stage.trace(await trueOutline('femur', 1));
  await page.getByRole('button', { name: 'Frame 1, femur: posed' }).or(page.getByRole('button', { name: /^Frame 1, femur: / })).first().waitFor();
  // A match or a refinement would have come.
  await atRest(page);
  const shown = await panel.shownPose(page);
  for (const [field] of FIELDS) assert.equal(shown?.[field], own[field], `${field} stays`);
  await byHand(page).waitFor();
}

/** @param {Page} page @param {Pose} truth @param {import('node:test').TestContext} t */
async function onTheOutline(page, truth, t) {
  await page.getByRole('button', { name: 'Adjust pose', exact: true }).last().click();
  const off = await numbers(page);
  await page.getByRole('button', { name: 'Lock z', exact: true }).click();
  await page.getByRole('button', { name: 'Refine from here' }).click();
  await panel.waitForWords(page, /against the outline: \d+\.\d\d px\. Held: z\.$/);
  const held = await numbers(page);
  assert.equal(held.z, off.z, 'z was locked');
  await page.getByRole('button', { name: 'Lock z', exact: true }).click();
  await page.getByRole('button', { name: 'Refine from here' }).click();
  await panel.waitForWords(page, /against the outline: \d+\.\d\d px\.$/);
  await until(() => numbers(page), (now) => now.z !== held.z, 'z to move');
  const found = await numbers(page);
  t.diagnostic(`held: ${panel.differences(held, truth)}; free: ${panel.differences(found, truth)}`);
  assert.equal(await panel.verdict(page), 'Good');
  panel.assertNear(found, truth, HAND_TRACED);
}

/** @param {Page} page */
async function compares(page) {
  await page.getByRole('button', { name: 'Done' }).click();
  await page.getByRole('application', { name: /outline$/ }).focus();
  await page.keyboard.press('q');
  const card = page.getByRole('region', { name: 'Pose numbers' });
  await card.getByRole('group', { name: /^x differs by [+\u2212]?\d+\.\d\d mm from the reference$/ }).waitFor();
  await card.getByRole('group', { name: /^y rotation differs by [+\u2212]?\d+\.\d\d degrees from the reference$/ }).waitFor();
  await page.getByRole('region', { name: 'Compare' }).getByText(/against femur\.jts · rotated by \d+\.\d\d°/).waitFor();
  await screenshot(page, 'compare');
  await page.getByRole('button', { name: 'Keep as reference' }).click();
  await card.getByRole('group', { name: /^x differs by 0\.00 mm from the reference$/ }).waitFor();
  await page.keyboard.press('q');
  await card.getByRole('group', { name: /^x differs/ }).waitFor({ state: 'detached' });
}

/** @param {Page} page */
async function session(page) {
  const before = await panel.shownPose(page);
  const saved = await exported(page, 'Session');
  const { results } = JSON.parse(saved.buffer.toString()).audit;
  const own = results.find((/** @type {any} */ { number, component }) => number === 1 && component === 'femur');
  assert.deepEqual([own.method, own.verdict.word], ['by hand, refined', 'good']);
  await page.getByRole('application', { name: /outline$/ }).focus();
  await page.keyboard.press('a');
  await page.keyboard.press('ArrowRight');
  await page.getByRole('button', { name: 'Done' }).click();
  await page.getByRole('button', { name: 'Done' }).waitFor({ state: 'detached' });
  await until(() => panel.shownPose(page), (pose) => pose?.x !== before?.x, 'another x');
  await drop(page, saved);
  await panel.waitForWords(page, /^Opened the session/);
  await panel.waitForThePose(page, /** @type {Pose} */ (before));
  await byHand(page).waitFor();
}

/** @param {Page} page @param {Pose} truth @param {import('node:test').TestContext} t */
async function dropped(page, truth, t) {
  await panel.waitForLibraries(page, 'Femur', 'Tibia');
  await page.getByRole('button', { name: 'Back to the page’s pose' }).click();
  await page.getByRole('radio', { name: 'Best candidate', checked: true }).waitFor();
  const pose = await panel.waitForPose(page);
  t.diagnostic(`found from the outline: ${panel.differences(pose, truth)}`);
  panel.assertNear(pose, truth, HAND_TRACED);
  await page.keyboard.press('Control+z');
  await byHand(page).waitFor();
}

/** @param {Page} page @param {Stage} stage */
async function placed(page, stage) {
  await page.getByRole('radio', { name: 'Tibia', exact: true }).click();
  await stage.canvas.focus();
  await page.keyboard.press('a');
  await panel.waitForWords(page, /^No pose of the tibia here: click where it is/);
  await page.getByRole('button', { name: 'Place the model' }).click();
  await panel.waitForWords(page, /^Placed in front of the camera/);
  const pose = await numbers(page);
  assert(pose.z < -500 && Math.abs(pose.x) < 200, `placed at ${JSON.stringify(pose)}`);
  assert.match(await panel.verdict(page), /^Doubtful: /);
  await page.keyboard.press('Escape');
  await page.getByRole('button', { name: 'Edit points', pressed: true }).waitFor();
  await stage.learn();
  // In the middle of the frame, where the model was placed.
  await page.mouse.dblclick(...stage.toPage([512, 512]));
  await page.getByRole('button', { name: 'Adjust pose', pressed: true }).waitFor();
}

/** What the pose card says of a pose that somebody set. @param {Page} page */
function byHand(page) {
  return page.getByRole('region', { name: 'Pose numbers' }).getByText(/Set by hand; the page does not change it\.$/);
}

/** Pixels, from the demonstration's calibration. */
async function focalLength() {
  const [, distance, , , pitch] = (await demoFile('calibration.txt')).buffer.toString().trim().split(/\s+/).map(Number);
  return distance / pitch;
}
