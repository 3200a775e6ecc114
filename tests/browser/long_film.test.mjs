/** A film of many frames: curves and their numbers, and a film of overlays that tells how far it is and can be called off. */
import assert from 'node:assert/strict';
import { pageTest, step, until } from './support/browser.mjs';
import { Calls } from './support/calls.mjs';
import { exportSheet, openExport } from './support/exporting.mjs';
import { joint, openLongFilm } from './support/long_film.mjs';
import * as panel from './support/panel.mjs';

/** @typedef {import('playwright-core').Page} Page */

const FRAMES = 120;

pageTest('a long film', async (page, t) => {
  await step(page, t, 'has all its numbers, and a curve leads to the frame under the pointer', async () => {
    await openLongFilm(page, FRAMES);
    const plot = joint(page).getByRole('img', { name: /^Flexion over frame/ });
    const box = await plot.boundingBox();
    assert(box);
    await page.mouse.click(box.x + 44 + ((79.5 / FRAMES) * (box.width - 52)), box.y + box.height / 2);
    const stage = page.getByRole('application', { name: /frame \d+ of 120/ });
    const shown = async () => Number(/frame (\d+) of/.exec((await stage.getAttribute('aria-label')) ?? '')?.[1]);
    const frame = await until(shown, (frame) => Math.abs(frame - 80) <= 1, 'the frame under the pointer');
    const flexion = await joint(page).getByRole('status', { name: `Flexion in frame ${frame}`, exact: true }).innerText();
    const wanted = 45 - 40 * Math.cos((4 * Math.PI * (frame - 1)) / FRAMES);
    // The two components are turned about x and y by a few degrees too.
    assert(Math.abs(Math.abs(Number(flexion.split('\n')[0].replace('\u2212', '-'))) - wanted) < 2, `${flexion}, not ${wanted}`);
  });
  await step(page, t, 'is written while the page goes on, and says how far it is', () => calledOff(page));
});

/** @param {Page} page */
async function calledOff(page) {
  const sheet = await openExport(page, 'Overlay film', 'PNG series');
  await sheet.getByRole('img', { name: 'Preview' }).waitFor();
  // All of them may be written in two seconds, sooner than a busy machine asks twice how far it is: most of them wait.
  const calls = await Calls.of(page, { method: 'add', most: 3 });
  await sheet.getByRole('button', { name: /^Save \S+\.zip$/ }).click();
  const job = page.getByRole('button', { name: 'Cancel: Writing the film' });
  await job.waitFor();
  const count = () => job.evaluate((button) => Number(/(\d+)\s*(?:of|\/)\s*120/.exec(button.parentElement?.parentElement?.textContent ?? '')?.[1] ?? 0));
  const first = await until(count, (done) => done > 0, 'how many pictures are done');
  // The page's own thread draws meanwhile: were it at work itself, all pictures would be written before a second screen frame.
  await page.evaluate(async () => {
    for (let frames = 0; frames < 3; frames++) await new Promise((resolve) => requestAnimationFrame(resolve));
  });
  assert.equal(await job.count(), 1, 'three screen frames, and the film is not yet written');
  await calls.allow(3);
  await until(count, (done) => done > first, 'more pictures');
  await job.click();
  await panel.waitForWords(page, /^Called off: \S+ was not written/);
  await calls.letGo();
  assert.equal(await exportSheet(page).count(), 1);
}
