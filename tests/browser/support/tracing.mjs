/** Ways from the empty page to an outline, with each tool, as a hand would go them. */
import assert from 'node:assert/strict';
import { atRest, drawn, until } from './browser.mjs';
import * as panel from './panel.mjs';
import { Stage } from './stage.mjs';
import { polygonWithin, trueOutline } from './study.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./study.mjs').Point} Point */

/** So far from the true border a quick hand clicks, px: some 30 points around a femur. */
const QUICK_HAND = 2.5;

/**
 * One click into the femur alone, or an outline that a tool laid on its edges (seen in z: 1.6 mm; threshold and live-wire 1.6, snapped 1.8): its profiles tell the
 * display from a sharpened picture.
 */
export const BY_ONE_CLICK = { x: 0.1, y: 0.1, z: 2.5, zRot: 0.2, xRot: 0.2, yRot: 0.5 };

/**
 * One click into each component: both tell the display alike. Seen, in either order: 1.6 mm of the femur (shown as +-1.7), 1.4 of the tibia (+-2.0),
 * 0.19 degrees of its y rotation.
 */
export const BY_TWO_CLICKS = { x: 0.05, y: 0.05, z: 2, zRot: 0.1, xRot: 0.1, yRot: 0.3 };

/** Counts presses of the mouse on anything from now on. @param {Page} page */
export async function countClicks(page) {
  await page.evaluate(() => {
    const counter = globalThis;
    counter.clicksSoFar = 0;
    addEventListener('pointerdown', () => counter.clicksSoFar++, { capture: true });
  });
  return () => page.evaluate(() => globalThis.clicksSoFar);
}

/** A point surely inside: the middle of the widest run of pixels that an outline holds on any row. @param {Point[]} outline @returns {Point} */
export function insideOf(outline) {
  const rows = outline.map(([, row]) => row);
  let best = { width: -1, at: /** @type {Point} */ ([NaN, NaN]) };
  for (let row = Math.ceil(Math.min(...rows)) + 0.37; row < Math.max(...rows); row++) {
    const crossings = outline.flatMap(([column, from], index) => {
      const [nextColumn, to] = outline[(index + 1) % outline.length];
      return from <= row !== to <= row ? [column + ((row - from) / (to - from)) * (nextColumn - column)] : [];
    });
    crossings.sort((a, b) => a - b);
    for (let pair = 0; pair + 1 < crossings.length; pair += 2) {
      const width = crossings[pair + 1] - crossings[pair];
      if (width > best.width) best = { width, at: [(crossings[pair] + crossings[pair + 1]) / 2, row] };
    }
  }
  return best.at;
}

/** From the empty page to libraries that are ready. @param {Page} page @param {number} [frames] of the demonstration, else all */
export async function openDemonstration(page, frames) {
  await panel.openDemonstration(page, frames);
  await panel.waitForLibraries(page, 'Femur', 'Tibia');
}

/** By one click inside a component, after opening: the pose once the film has been asked. @param {Page} page @param {'femur' | 'tibia'} [component] */
export async function byOneClick(page, component = 'femur') {
  const stage = new Stage(page);
  const inside = insideOf(await trueOutline(component, 1));
  await page.keyboard.press('o');
  await stage.learn();
  await stage.click(inside);
  await panel.waitForPose(page);
  await atRest(page);
  return panel.waitForPose(page);
}

/** The pose once the frame has told its film, and that where the edges are. @param {Page} page */
export async function corrected(page) {
  await panel.waitForPose(page);
  await atRest(page);
  return panel.waitForPose(page);
}

/** By clicks around the femur, few and quick. @param {Page} page */
export async function byPolygon(page) {
  const stage = new Stage(page);
  const outline = await polygonWithin('femur', 1, QUICK_HAND);
  await page.keyboard.press('p');
  await stage.zoomTo(outline);
  await stage.trace(outline);
  return panel.waitForPose(page);
}

/**
 * Round an outline with the live-wire: seeds at some of its points, the mouse going along the border between them, as a
 * hand does.
 *
 * @param {Page} page
 * @param {Stage} stage
 * @param {Point[]} outline
 * @param {number} seeds
 */
export async function wireRound(page, stage, outline, seeds) {
  const way = alongRing(outline, 12);
  const every = Math.ceil(way.length / seeds);
  await page.keyboard.press('l');
  await ready(page, stage, way[0]);
  for (const [index, point] of way.entries()) {
    if (index % every === 0) await stage.click(point);
    else await stage.hover(point);
  }
  await page.keyboard.press('Enter');
}

/** The live-wire looks at the frame once: a moment in which the hand comes to the frame. @param {Page} page @param {Stage} stage @param {Point} point */
async function ready(page, stage, point) {
  await stage.hover(point);
  await drawn(page);
}

/** Points along a ring, about so far from each other. @param {Point[]} ring @param {number} step @returns {Point[]} */
export function alongRing(ring, step) {
  return ring.flatMap(([column, row], index) => {
    const [toColumn, toRow] = ring[(index + 1) % ring.length];
    const pieces = Math.max(1, Math.round(Math.hypot(toColumn - column, toRow - row) / step));
    return Array.from({ length: pieces }, (_, piece) => {
      const part = piece / pieces;
      return /** @type {Point} */ ([column + part * (toColumn - column), row + part * (toRow - row)]);
    });
  });
}

/** What the strip above the frame says of the tool. @param {Page} page */
export function strip(page) {
  return page.getByRole('region', { name: 'Tool options' });
}

/** The state of a cell in the strip. @param {Page} page @param {RegExp} wanted */
export async function waitForCell(page, wanted) {
  await until(() => panel.cells(page), (cells) => cells.some((cell) => wanted.test(cell)), `a cell like ${wanted}`);
}

/** @param {Page} page @param {string} name */
export async function toolInHand(page, name) {
  const button = page.getByRole('navigation', { name: 'Tools' }).getByRole('button', { name, exact: true });
  await until(() => button.getAttribute('aria-pressed'), (pressed) => pressed === 'true', `${name} to be in hand`);
  assert.equal(await page.getByRole('navigation', { name: 'Tools' }).getByRole('button', { pressed: true }).count(), 1);
}
