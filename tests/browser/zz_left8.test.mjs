import { readFile, readdir } from 'node:fs/promises';
import { atRest, pageTest, screenshot } from './support/browser.mjs';
import { choose } from './support/files.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { readJts } from './support/study.mjs';
const L = '/work/shared/studies/left8/';
const f = async (p, name) => ({ name: name ?? p.split('/').at(-1), mimeType: 'application/octet-stream', buffer: await readFile(L + p) });
pageTest('left8', async (page, t) => {
  const inside = JSON.parse(await readFile('/tmp/b/hp_inside.json', 'utf8'));
  const truth = { femur: readJts(await readFile(L + 'fem.jts', 'utf8')), tibia: readJts(await readFile(L + 'tib.jts', 'utf8')) };
  const frames = (await readdir(L + 'frames')).sort();
  await choose(page, await f('study.toml'), await f('calibration.txt'), await f('KR_left_8_fem.stl'), await f('KR_left_8_tib.stl'), ...(await Promise.all(frames.map((n) => f('frames/' + n)))));
  await panel.waitForFrames(page, 16);
  await panel.waitForLibraries(page, 'Femur', 'Tibia');
  const stage = new Stage(page);
  await page.keyboard.press('Escape');
  await stage.learn();
  const report = async (component, frame, what) => {
    const pose = await panel.shownPose(page);
    if (!pose) return t.diagnostic(`${what} ${component} ${frame}: no pose`);
    const sd = await panel.deviations(page).catch(() => null);
    const note = await page.getByRole('region', { name: 'Film' }).innerText().catch(() => '');
    t.diagnostic(`${what} ${component} ${frame}: ${panel.differences(pose, truth[component][frame - 1])} z+-${sd?.z}; ${await panel.verdict(page)}; ${note.replace(/\n/g, ' ')}`);
  };
  const list = (process.env.FRAMES ?? '1,4,8,12').split(',').map(Number);
  let at = 1;
  const to = async (frame) => { while (at < frame) { await page.keyboard.press('f'); at++; } while (at > frame) { await page.keyboard.press('d'); at--; } await atRest(page); };
  const choosec = async (c) => { await page.getByRole('radio', { name: c === 'femur' ? 'Femur' : 'Tibia' }).click(); await atRest(page); };
  for (const frame of list) {
    await to(frame);
    for (const component of ['femur', 'tibia']) {
      await choosec(component);
      await page.keyboard.press('o');
      const t0 = performance.now();
      await stage.click(inside[component === 'femur' ? 'fem' : 'tib'][frame - 1]);
      await panel.waitForPose(page).catch(() => null);
      const t1 = performance.now();
      if (process.env.FIRST) await report(component, frame, 'first');
      await atRest(page);
      t.diagnostic(`${component} ${frame}: pose after ${Math.round(t1 - t0)} ms, at rest after ${Math.round(performance.now() - t0)} ms`);
    }
  }
  for (const frame of list) { await to(frame); for (const c of ['femur', 'tibia']) { await choosec(c); await report(c, frame, 'end'); } }
  await screenshot(page, 'left8 measured');
});
