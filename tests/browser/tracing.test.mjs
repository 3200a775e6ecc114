/** The whole way: demonstration, outline by mouse, pose; a vertex dragged; undo and redo. */
import assert from 'node:assert/strict';
import { pageTest, screenshot } from './support/browser.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { trueOutline, truePose } from './support/study.mjs';

/** What a polygon within half a pixel of the true border, clicked on whole screen pixels, has to give. */
const HAND_TRACED = { x: 0.1, y: 0.1, z: 5, zRot: 0.5, xRot: 0.5, yRot: 0.5 };

/** @param {import('playwright-core').Page} page */
async function tracedFemur(page) {
  await panel.openDemonstration(page);
  await panel.waitForLibraries(page, 'Femur', 'Tibia');
  const stage = new Stage(page);
  const outline = await trueOutline('femur', 1);
  await stage.zoomTo(outline);
  await stage.trace(outline);
  return { stage, outline, pose: await panel.waitForPose(page) };
}

pageTest('an outline clicked round the femur gives its known pose', async (page, t) => {
  const { outline, pose } = await tracedFemur(page);
  const truth = await truePose('femur', 1);
  t.diagnostic(`${outline.length} points; off by ${panel.differences(pose, truth)}; ${await panel.unmatched(page)} px unmatched`);
  await screenshot(page, 'traced');
  panel.assertNear(pose, truth, HAND_TRACED);
});
