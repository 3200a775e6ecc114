/** How fast both components are followed through the demonstration, and what the hand feels of it. */
import { atRest, until } from '../support/browser.mjs';
import * as panel from '../support/panel.mjs';
import { Stage } from '../support/stage.mjs';
import { trueOutline } from '../support/study.mjs';
import * as tracing from '../support/tracing.mjs';
import { figures, recorded } from './interaction.mjs';

/** @typedef {import('playwright-core').Page} Page */

const FOLLOWED = 7;
const FOLLOW = 'Shift+G';

/** @param {Page} page @returns {Promise<import('./main.mjs').Row[]>} */
export async function following(page) {
  const stage = await clickedOnce(page);
  const seconds = await followed(page);
  await page.keyboard.press('Control+z');
  await atRest(page);
  const dragged = await recorded(page, () => meanwhile(page, () => pan(page, stage)));
  await page.keyboard.press('Control+z');
  await atRest(page);
  const played = await recorded(page, () => meanwhile(page, () => play(page)));
  return [
    { work: 'following, both components, frames a second', value: FOLLOWED / seconds, unit: 'a second' },
    ...figures('dragging the frame while the film is followed', dragged),
    ...figures('playing while the film is followed', played),
  ];
}

/** One click into each component of the first frame. @param {Page} page */
async function clickedOnce(page) {
  await tracing.openDemonstration(page);
  const stage = new Stage(page);
  await stage.learn();
  for (const component of /** @type {const} */ (['femur', 'tibia'])) {
    await stage.click(tracing.insideOf(await trueOutline(component, 1)));
    await until(() => panel.cells(page), (cells) => cells.some((cell) => cell.startsWith(`Frame 1, ${component}: posed`)), `the ${component}`);
  }
  await atRest(page);
  return stage;
}

/** @param {Page} page */
async function isFollowed(page) {
  const cells = await panel.cells(page);
  return cells.filter((cell) => /: followed(,|$)/.test(cell)).length === 2 * FOLLOWED;
}

/** Seconds until the last frame has its word. @param {Page} page */
async function followed(page) {
  const from = performance.now();
  await page.keyboard.press(FOLLOW);
  await until(() => isFollowed(page), (is) => is, 'the film to be followed');
  return (performance.now() - from) / 1000;
}

/** A hand's work again and again until the film is followed. @param {Page} page @param {() => Promise<void>} work */
async function meanwhile(page, work) {
  await page.keyboard.press(FOLLOW);
  while (!(await isFollowed(page))) await work();
}

/** @param {Page} page @param {Stage} stage */
async function pan(page, stage) {
  await stage.hover([500, 500]);
  await page.mouse.down({ button: 'middle' });
  for (let step = 0; step < 60; step++) await stage.hover([500 + 60 * Math.sin(step / 6), 500 + 60 * Math.cos(step / 6)]);
  await page.mouse.up({ button: 'middle' });
}

/** Through the film and back by keys. @param {Page} page */
async function play(page) {
  for (const key of ['f', 'd']) for (let step = 0; step < FOLLOWED; step++) await page.keyboard.press(key);
}
