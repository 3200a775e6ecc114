/** What leaves the page comes back into it: poses as .jts, the whole work as a session. */
import assert from 'node:assert/strict';
import { pageTest, step, until, visit } from './support/browser.mjs';
import { exported } from './support/exporting.mjs';
import { choose, drop } from './support/files.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { HAND_TRACED, demoFile, framePath, readJts, trueOutline, truePose } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./support/files.mjs').FileToOpen} FileToOpen */
/** @typedef {Awaited<ReturnType<typeof traceFrames>>} Traced frames with their poses and pictures */

const TRACED = [2, 3];
const FRAMES = 3;
const NAME = 'knee 7';
const DISPLAY = { 'Window width': 150, 'Window level': 90, 'Overlay opacity': 0.6 };

pageTest('poses and sessions come back as they left', async (page, t) => {
  const stage = new Stage(page);
  const frames = await Promise.all(Array.from({ length: FRAMES }, (_, index) => demoFile(framePath(index + 1))));
  /** @type {Traced} */
  let traced = [];
  /** @type {FileToOpen[]} */
  const saved = [];

  await step(page, t, 'two frames are traced', async () => {
    await choose(page, ...frames, await demoFile('calibration.txt'), await demoFile('femur.stl'));
    await panel.waitForFrames(page, FRAMES);
    await panel.waitForLibraries(page, 'Femur');
    traced = await traceFrames(page, stage);
  });

  await step(page, t, 'the .jts file holds the numbers that are shown', async () => {
    const jts = await exported(page, 'Poses', 'JTS', 'Femur');
    assert.match(jts.name, /_femur\.jts$/);
    await checkRows(readJts(jts.buffer.toString()), traced);
    saved.push(jts);
  });

  await step(page, t, 'a number is copied with all its decimals', async () => {
    await page.getByRole('button', { name: /^x rotation / }).click();
    const rows = readJts(saved[0].buffer.toString());
    const copied = () => page.evaluate(() => navigator.clipboard.readText());
    await until(copied, (text) => rows.some(({ xRot }) => xRot === Number(text)), 'the x rotation of a row');
  });

  await step(page, t, 'a session is saved', async () => saved.push(await savedSession(page, stage, traced)));
  await step(page, t, 'the .jts file is read back into a fresh page', () => readBack(page, frames, saved[0], traced));

  await step(page, t, 'a session brings everything back into a fresh page', async () => {
    let asked = false;
    page.on('dialog', (dialog) => {
      asked = true;
      void dialog.accept();
    });
    await panel.waitUntilKept(page);
    await visit(page);
    assert.equal(asked, false, 'what is kept in the browser may be left without a question');
    await drop(page, saved[1]);
    await panel.waitForFrames(page, FRAMES);
    await panel.waitForLibraries(page, 'Femur');
    await sameWork(page, stage, traced);
  });
});

/** @param {Page} page @param {Stage} stage @param {Traced} traced gains pictures of the frames */
async function savedSession(page, stage, traced) {
  await page.getByRole('textbox', { name: 'Name of the study' }).fill(NAME);
  for (const [name, value] of Object.entries(DISPLAY)) await page.getByRole('slider', { name }).fill(String(value));
  for (const work of traced) work.picture = await pictureOf(page, stage, work.frame);
  const session = await exported(page, 'Session');
  assert.equal(session.name, 'knee_7.fluoropose.json');
  return session;
}

/** @param {Page} page @param {FileToOpen[]} frames @param {FileToOpen} jts @param {Traced} traced */
async function readBack(page, frames, jts, traced) {
  await visit(page);
  await choose(page, ...frames);
  await panel.waitForFrames(page, FRAMES);
  await choose(page, jts);
  await panel.waitForWords(page, /as poses of the femur/);
  for (const { frame, pose } of traced) {
    await goTo(page, frame);
    await panel.waitForThePose(page, pose);
  }
  await goTo(page, 1);
  await until(() => panel.shownPose(page), (pose) => pose === null, 'frame 1 to be without a pose');
}

/** @param {Page} page @param {Stage} stage */
async function traceFrames(page, stage) {
  const done = [];
  for (const frame of TRACED) {
    await goTo(page, frame);
    const outline = await trueOutline('femur', frame);
    await stage.zoomTo(outline);
    await stage.trace(outline);
    const pose = await panel.waitForPose(page);
    panel.assertNear(pose, await truePose('femur', frame), HAND_TRACED);
    await page.keyboard.press('0');
    done.push({ frame, pose, picture: Buffer.alloc(0) });
  }
  return done;
}

/** @param {import('./support/study.mjs').Pose[]} rows @param {Traced} traced */
async function checkRows(rows, traced) {
  assert.equal(rows.length, FRAMES);
  for (const { frame, pose } of traced) {
    panel.assertNear(rows[frame - 1], pose, panel.ROUNDING);
    panel.assertNear(rows[frame - 1], await truePose('femur', frame), HAND_TRACED);
  }
  assert(Object.values(rows[0]).every(Number.isNaN), 'a frame without a pose is a row of NaN');
}

/** @param {Page} page @param {Stage} stage @param {Traced} traced */
async function sameWork(page, stage, traced) {
  const femur = async () => (await panel.cells(page)).filter((name) => name.includes('femur'));
  await until(femur, (cells) => cells.join('; ') === 'Frame 1, femur: empty; Frame 2, femur: posed; Frame 3, femur: posed', 'the cells to be as they were');
  for (const [name, value] of Object.entries(DISPLAY)) await until(() => panel.slider(page, name), (now) => now === value, `a ${name} of ${value}`);
  await until(() => page.getByRole('textbox', { name: 'Name of the study' }).inputValue(), (name) => name === NAME, 'the name of the study');
  await panel.waitUntilKept(page);
  for (const { frame, pose, picture } of traced) {
    await goTo(page, frame);
    await panel.waitForThePose(page, pose);
    await stage.looksLike(picture, `frame ${frame}`);
  }
}

/** The whole frame with outline and silhouette. @param {Page} page @param {Stage} stage @param {number} frame */
async function pictureOf(page, stage, frame) {
  await goTo(page, frame);
  return stage.picture();
}

/** @param {Page} page @param {number} frame from 1 */
async function goTo(page, frame) {
  await page.getByRole('slider', { name: 'Frame', exact: true }).fill(String(frame - 1));
  await page.getByRole('application', { name: new RegExp(`frame ${frame} of`) }).waitFor();
}
