/** The whole way from the empty page to a refined pose, for tests of where and how the page runs. */
import * as panel from './panel.mjs';
import { Stage } from './stage.mjs';
import { HAND_TRACED, trueOutline, truePose } from './study.mjs';
import { corrected } from './tracing.mjs';

/**
 * Opens the demonstration, traces its first femur by mouse and checks the pose that comes of it.
 *
 * @param {import('playwright-core').Page} page
 */
export async function fromOpeningToPose(page) {
  await panel.openDemonstration(page);
  await panel.waitForLibraries(page, 'Femur', 'Tibia');
  return traceFemur(page);
}

/** The same once the demonstration is open. @param {import('playwright-core').Page} page */
export async function traceFemur(page) {
  const stage = new Stage(page);
  const outline = await trueOutline('femur', 1);
  await stage.zoomTo(outline);
  await stage.trace(outline);
  const pose = await corrected(page);
  panel.assertNear(pose, await truePose('femur', 1), HAND_TRACED);
  return { pose, outline, stage };
}
