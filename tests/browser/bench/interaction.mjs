/** How long the page's thread takes for a frame while a hand moves over the frame. */
import * as tracing from '../support/tracing.mjs';
import { drawn } from '../support/browser.mjs';
import * as panel from '../support/panel.mjs';
import { Stage } from '../support/stage.mjs';
import { trueOutline } from '../support/study.mjs';
import { quantile } from './speed.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('../support/study.mjs').Point} Point */

/** A point of a closed outline goes round in small circles, and the pose with it. @param {Page} page */
export async function dragging(page) {
  const { stage, outline } = await prepared(page);
  await stage.zoomTo(outline);
  await stage.trace(outline);
  await panel.waitForPose(page);
  const [column, row] = outline[0];
  await stage.hover([column, row]);
  await page.mouse.down();
  const frames = await recorded(page, async () => {
    for (let step = 0; step < 300; step++) {
      const angle = step / 8;
      await stage.hover([column + 6 * Math.sin(angle), row + 6 * (1 - Math.cos(angle))]);
    }
  });
  await page.mouse.up();
  return figures('dragging a vertex, the pose following', frames);
}

/** The path from the last seed to the mouse, which goes twice around the implant's edge. @param {Page} page */
export async function wiring(page) {
  const { stage, outline } = await prepared(page);
  // Both cores work at libraries before.
  await panel.waitForLibraries(page, 'Femur', 'Tibia');
  await page.keyboard.press('l');
  const way = tracing.alongRing(outline, 4);
  await stage.click(way[0]);
  await drawn(page);
  const frames = await recorded(page, async () => {
    for (const point of [...way, ...way]) await stage.hover(point);
  });
  return figures('live-wire', frames);
}

/** @param {Page} page */
async function prepared(page) {
  await tracing.openDemonstration(page);
  const stage = new Stage(page);
  await stage.learn();
  return { stage, outline: await trueOutline('femur', 1) };
}

/** @typedef {{ begin: number, work: number }} Frame milliseconds */

/**
 * Each frame that the page draws while `work` goes on: when it began, and how long its thread was busy with it, from the
 * frame's begin (input and scripts included) until everything is handed on to be drawn.
 *
 * @param {Page} page
 * @param {() => Promise<void>} work
 * @returns {Promise<Frame[]>}
 */
export async function recorded(page, work) {
  await page.evaluate(() => {
    /** @type {Frame[]} */
    const frames = (globalThis.framesSoFar = []);
    globalThis.recording = true;
    const { port1, port2 } = new MessageChannel();
    let begin = 0;
    port1.onmessage = () => frames.push({ begin, work: performance.now() - begin });
    const tick = (/** @type {number} */ time) => {
      begin = time;
      port2.postMessage(null);
      if (globalThis.recording) requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  });
  await work();
  return page.evaluate(() => {
    globalThis.recording = false;
    return globalThis.framesSoFar;
  });
}

/** @param {string} what @param {Frame[]} frames @returns {import('./main.mjs').Row[]} */
export function figures(what, frames) {
  const intervals = frames.slice(1).map(({ begin }, index) => begin - (frames[index]?.begin ?? begin));
  return [
    { work: `frame time, ${what}, p95`, value: quantile(frames.map((frame) => frame.work), 0.95), unit: 'ms' },
    { work: `frame time, ${what}, median`, value: quantile(frames.map((frame) => frame.work), 0.5), unit: 'ms' },
    { work: `from frame to frame, ${what}, p95`, value: quantile(intervals, 0.95), unit: 'ms' },
    { work: `frames recorded, ${what}`, value: frames.length, unit: 'frames' },
  ];
}
