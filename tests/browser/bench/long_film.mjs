/** A film of 2000 frames with its joint: how soon the curves answer, and what the page's thread does while a film of it is written. */
import { atRest, until } from '../support/browser.mjs';
import { exportSheet, openExport } from '../support/exporting.mjs';
import { joint, openLongFilm } from '../support/long_film.mjs';
import * as panel from '../support/panel.mjs';
import { figures, recorded } from './interaction.mjs';

/** @typedef {import('playwright-core').Page} Page */

const FRAMES = 2000;

/** @param {Page} page @returns {Promise<import('./main.mjs').Row[]>} */
export async function long(page) {
  const seconds = await openLongFilm(page, FRAMES);
  await atRest(page);
  const plot = joint(page).getByRole('img', { name: /^Flexion over frame/ });
  const box = await plot.boundingBox();
  if (!box) throw new Error('no curve is in sight');
  const hovered = await recorded(page, async () => {
    for (let step = 0; step < 150; step++) await page.mouse.move(box.x + 50 + ((step * 37) % (box.width - 70)), box.y + box.height / 2);
  });
  const stepped = await recorded(page, async () => {
    for (let step = 0; step < 60; step++) await page.keyboard.press('f');
  });
  return [
    { work: `joint of ${FRAMES} frames, all numbers`, value: seconds, unit: 's' },
    ...figures(`pointer over the curves of ${FRAMES} frames`, hovered),
    ...figures(`next frame beside the curves of ${FRAMES} frames`, stepped),
    ...(await written(page)),
  ];
}

/** A PNG of each frame, called off after some; the page's thread meanwhile, and how long it takes to stop. @param {Page} page */
async function written(page) {
  const sheet = await openExport(page, 'Overlay film', 'PNG series');
  await sheet.getByRole('img', { name: 'Preview' }).waitFor();
  await sheet.getByRole('button', { name: /^Save \S+\.zip$/ }).click();
  const cancel = page.getByRole('button', { name: 'Cancel: Writing the film' });
  await cancel.waitFor();
  const from = performance.now();
  const meanwhile = await recorded(page, async () => page.waitForTimeout(5000));
  const told = await cancel.evaluate((button) => button.parentElement?.parentElement?.textContent ?? '');
  const done = Number(new RegExp(`(\\d+)\\s*(?:of|/)\\s*${FRAMES}`).exec(told)?.[1] ?? NaN);
  const seconds = (performance.now() - from) / 1000;
  const asked = performance.now();
  await cancel.click();
  await panel.waitForWords(page, /^Called off: \S+ was not written/);
  const stopped = performance.now() - asked;
  await until(() => cancel.count(), (count) => count === 0, 'the job to be gone');
  await exportSheet(page).press('Escape');
  return [
    ...figures('a film of overlays being written', meanwhile),
    { work: 'overlays written', value: done / seconds, unit: 'a second' },
    { work: 'overlay film, called off', value: stopped, unit: 'ms' },
  ];
}
