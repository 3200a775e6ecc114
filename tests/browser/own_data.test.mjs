/** One's own data: a frame, a calibration and a model as files, no demonstration. */
import assert from 'node:assert/strict';
import { pageTest, says, step, until } from './support/browser.mjs';
import { choose, drop, file } from './support/files.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { HAND_TRACED, demoFile, framePath, trueOutline, truePose } from './support/study.mjs';

const FRAME = 6;

/** Pixels of the demonstration's focal length: 1200 mm at 0.373 mm each. */
const FOCAL = 1200 / 0.373;

/** A camera as MayaCam 2.0 writes it, with no word of millimetres. @param {number} focal */
const cameraMatrix = (focal) => `image size
1024,1024

camera matrix
${focal},0,511.5
0,${focal},511.5
0,0,1

rotation
1,0,0
0,1,0
0,0,1

translation
0
0
0
`;

pageTest('own files to a pose', async (page, t) => {
  const stage = new Stage(page);
  const needs = page.getByRole('region', { name: 'Pose numbers' });

  await step(page, t, 'the page says what is missing, file by file', async () => {
    await drop(page, await demoFile(framePath(FRAME)));
    await panel.waitForFrames(page, 1);
    await says(needs, /For a pose: a calibration, a model .* outline/);
    await choose(page, { ...(await demoFile('calibration.txt')), name: 'C-arm 2.txt' });
    await page.getByRole('button', { name: 'Calibration: C-arm 2.txt' }).waitFor();
    await says(needs, /For a pose: a model .* outline/);
  });

  await step(page, t, 'a library that is being built can be called off', async () => {
    // At once, by the page itself: whoever looks for the button from outside may come after the library on a busy machine.
    await page.evaluate(() => {
      const name = 'Cancel: Femur library';
      const watch = new MutationObserver(() => {
        const buttons = [...document.querySelectorAll('button')];
        const cancel = buttons.find((button) => button.ariaLabel === name || button.textContent === name);
        if (!cancel) return;
        watch.disconnect();
        cancel.click();
      });
      watch.observe(document.body, { childList: true, subtree: true });
    });
    await choose(page, { ...(await demoFile('femur.stl')), name: 'size 4.stl' });
    await panel.waitForWords(page, /called off/);
    await until(() => page.getByRole('progressbar').count(), (count) => count === 0, 'nothing to be under way');
  });

  await step(page, t, 'and built when asked for', async (t) => {
    await page.getByRole('button', { name: /^Femur: size 4\.stl/ }).click();
    const sheet = page.getByRole('dialog', { name: 'Femur' });
    await sheet.getByRole('button', { name: 'Build the library' }).click();
    await panel.waitForJob(page, /^Femur library: /);
    const ready = await says(sheet, /Library: 10368 views/);
    t.diagnostic(/Library: .* s\./.exec(ready)?.[0] ?? ready);
    await sheet.getByRole('button', { name: 'Close Femur' }).click();
  });

  await step(page, t, 'an outline gives the pose', async (t) => {
    const outline = await trueOutline('femur', FRAME);
    await stage.zoomTo(outline);
    await stage.trace(outline);
    const pose = await panel.waitForPose(page);
    const truth = await truePose('femur', FRAME);
    t.diagnostic(`${outline.length} points: ${panel.differences(pose, truth)}`);
    panel.assertNear(pose, truth, HAND_TRACED);
  });

  await step(page, t, 'a camera matrix will do, without any distance', (t) => byCameraMatrix(page, needs, t));
  await step(page, t, 'a window of views is a choice', () => windowOfViews(page));
}, { builds: true });

/** @param {import('playwright-core').Page} page @param {import('playwright-core').Locator} shown @param {import('node:test').TestContext} t */
async function byCameraMatrix(page, shown, t) {
  await choose(page, file('cube.txt', cameraMatrix(FOCAL)));
  await page.getByRole('button', { name: 'Calibration: cube.txt' }).waitFor();
  await until(() => shown.innerText(), (text) => !/Found with another/.test(text) && /refined/.test(text), 'a pose by the new camera');
  const pose = await panel.waitForPose(page);
  const truth = await truePose('femur', FRAME);
  t.diagnostic(panel.differences(pose, truth));
  panel.assertNear(pose, truth, HAND_TRACED);
}

/** @param {import('playwright-core').Page} page */
async function windowOfViews(page) {
  await page.getByRole('button', { name: /^Femur: size 4\.stl/ }).click();
  const sheet = page.getByRole('dialog', { name: 'Femur' });
  assert.equal(await sheet.getByLabel('Nominal x (°)').count(), 0, 'all directions ask for no nominal view');
  await sheet.getByRole('radio', { name: 'A window of views' }).click();
  await sheet.getByLabel('Nominal x (°)').fill('5');
  await sheet.getByText('1271 views').waitFor();
  await sheet.getByRole('button', { name: 'Use these views' }).click();
  await says(sheet, /Library: 1271 views/);
  await sheet.getByRole('radio', { name: 'All directions' }).click();
  await sheet.getByRole('button', { name: 'Use these views' }).click();
  await says(sheet, /Library: 10368 views/);
}
