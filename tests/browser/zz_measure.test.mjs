import { atRest, pageTest, screenshot } from './support/browser.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { trueOutline, truePose } from './support/study.mjs';
import * as tracing from './support/tracing.mjs';
pageTest('measure', async (page, t) => {
  await tracing.openDemonstration(page);
  const stage = new Stage(page);
  const frames = (process.env.FRAMES ?? '1,3,6').split(',').map(Number);
  const order = (process.env.ORDER ?? 'femur,tibia').split(',');
  await stage.learn();
  const report = async (component, frame, what) => {
    const pose = await panel.shownPose(page);
    const sd = await panel.deviations(page).catch(() => null);
    const note = await page.getByRole('region', { name: 'Film' }).innerText().catch(() => '');
    t.diagnostic(`${what} ${component} ${frame}: ${panel.differences(pose, await truePose(component, frame))} z+-${sd?.z} rot+-${sd?.zRot},${sd?.xRot},${sd?.yRot}; ${await panel.verdict(page)}; ${note.replace(/\n/g, ' ')}`);
  };
  let at = 1;
  for (const frame of frames) {
    while (at < frame) { await page.keyboard.press('f'); at++; }
    await atRest(page);
    for (const component of order) {
      await page.getByRole('radio', { name: component === 'femur' ? 'Femur' : 'Tibia' }).click();
      await page.keyboard.press('o');
      const t0 = performance.now();
      await stage.click(tracing.insideOf(await trueOutline(component, frame)));
      await panel.waitForPose(page);
      const t1 = performance.now();
      if (process.env.FIRST) await report(component, frame, 'first');
      await atRest(page);
      t.diagnostic(`${component} ${frame}: pose after ${Math.round(t1 - t0)} ms, at rest after ${Math.round(performance.now() - t0)} ms`);
      await report(component, frame, 'rest ');
    }
    await page.getByRole('radio', { name: 'Femur' }).click();
    await report('femur', frame, 'then ');
  }
  await screenshot(page, 'film measured');
});
