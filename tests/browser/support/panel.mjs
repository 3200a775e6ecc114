/** What the page says in words and numbers, by role and accessible name. */
import assert from 'node:assert/strict';
import { ADDRESS, atRest, drawn, until } from './browser.mjs';
import { demoFile } from './study.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./study.mjs').Pose} Pose */

/** Frames of the demonstration. */
const DEMONSTRATED = 8;

const QUANTITIES = /** @type {const} */ ([
  ['x', 'x', 'mm'],
  ['y', 'y', 'mm'],
  ['z', 'z', 'mm'],
  ['zRot', 'z rotation', 'degrees'],
  ['xRot', 'x rotation', 'degrees'],
  ['yRot', 'y rotation', 'degrees'],
]);

/** The six numbers by their accessible names; null while there is no pose. @param {Page} page @returns {Promise<Pose | null>} */
export async function shownPose(page) {
  const snapshot = await page.getByRole('region', { name: 'Pose numbers' }).ariaSnapshot();
  const texts = QUANTITIES.map(([, name, unit]) => {
    return new RegExp(`button "${name} (\\S+) ${unit}"`).exec(snapshot)?.[1] ?? null;
  });
  if (texts.every((text) => text === null)) return null;
  assert(texts.every((text) => text !== null), `some numbers and not others in\n${snapshot}`);
  // The page writes a true minus sign.
  const values = texts.map((text) => Number(text?.replace('\u2212', '-')));
  assert(values.every(Number.isFinite), `not numbers: ${texts.join(', ')}`);
  return /** @type {Pose} */ (Object.fromEntries(QUANTITIES.map(([field], index) => [field, values[index]])));
}

/** One standard deviation of each number, as it is shown beside it. @param {Page} page @returns {Promise<Pose>} */
export async function deviations(page) {
  const snapshot = await page.getByRole('region', { name: 'Pose numbers' }).ariaSnapshot();
  const entries = QUANTITIES.map(([field, name, unit]) => {
    const found = new RegExp(`group "${name} plus or minus (\\S+) ${unit}"`).exec(snapshot);
    assert(found, `no plus-minus of ${name} in\n${snapshot}`);
    return [field, Number(found[1])];
  });
  return /** @type {Pose} */ (Object.fromEntries(entries));
}

/** Is the pose that is shown still to be refined? @param {Page} page */
async function isProvisional(page) {
  return (await page.getByRole('group', { name: /^Unmatched pixels.*being refined$/ }).count()) > 0;
}

/** The pose once it is refined, or cannot be. @param {Page} page */
export async function waitForPose(page) {
  const settled = async () => {
    const before = await shownPose(page);
    const provisional = await isProvisional(page);
    const pose = await shownPose(page);
    // The answers are not of one moment: the refined pose may have come between them.
    return !provisional && before && pose && samePose(before, pose) ? pose : null;
  };
  const pose = await until(settled, (pose) => pose !== null, 'a pose');
  return /** @type {Pose} */ (pose);
}

/** The next pose that differs from one shown before, once it has come to rest and is refined. @param {Page} page @param {Pose} before */
export async function waitForOtherPose(page, before) {
  const differs = (/** @type {Pose | null} */ pose) => pose !== null && !samePose(pose, before);
  await until(() => shownPose(page), differs, 'the pose to change');
  await atRest(page);
  const pose = await shownPose(page);
  assert(pose && !(await isProvisional(page)), 'the page is at rest, and its pose neither gone nor provisional');
  return pose;
}

/** @param {Page} page @param {Pose} wanted */
export async function waitForThePose(page, wanted) {
  await until(() => shownPose(page), (pose) => pose !== null && samePose(pose, wanted), `the pose ${JSON.stringify(wanted)}`);
}

/** @param {Pose} a @param {Pose} b */
export function samePose(a, b) {
  return QUANTITIES.every(([field]) => a[field] === b[field]);
}

/**
 * Asserts that each number lies within its tolerance of the wanted one.
 *
 * @param {Pose} pose
 * @param {Pose} wanted
 * @param {Pose} tolerance
 */
export function assertNear(pose, wanted, tolerance) {
  const far = QUANTITIES.filter(([field]) => !(Math.abs(pose[field] - wanted[field]) <= tolerance[field]));
  const words = far.map(([field]) => `${field} ${pose[field]} for ${wanted[field]} (within ${tolerance[field]})`);
  assert.equal(far.length, 0, words.join('; '));
}

/** Signed differences, for diagnostics. @param {Pose} pose @param {Pose} wanted */
export function differences(pose, wanted) {
  return QUANTITIES.map(([field]) => `${field} ${(pose[field] - wanted[field]).toFixed(3)}`).join(', ');
}

/** Half of the last decimal shown. @type {Pose} */
export const ROUNDING = { x: 0.00501, y: 0.00501, z: 0.0501, zRot: 0.00501, xRot: 0.00501, yRot: 0.00501 };

/** Unmatched pixels of the chosen candidate. @param {Page} page */
export async function unmatched(page) {
  const text = await page.getByRole('group', { name: 'Unmatched pixels' }).innerText();
  return Number(text.replace(/\s/g, ''));
}

/** How far the pose is to be trusted, once the panel says it. @param {Page} page */
export async function verdict(page) {
  await atRest(page);
  return (await page.getByRole('group', { name: 'Verdict' }).innerText()).trim();
}

/** What the bottom line says. @param {Page} page */
export function said(page) {
  return page.getByRole('contentinfo', { name: 'Status' }).getByRole('status').innerText();
}

/** Waits until the bottom line says something, or has said it since the last press, drop or choice of a file. @param {Page} page @param {RegExp} pattern */
export async function waitForWords(page, pattern) {
  const words = async () => [...(await page.evaluate(() => globalThis.saidSoFar.status)), await said(page)];
  return lastLike(words, pattern, `the status line to say ${pattern}`);
}

/** Waits until a job that the bottom line tells of is under way, or has been since then: its title and how far it is. @param {Page} page @param {RegExp} pattern */
export function waitForJob(page, pattern) {
  return lastLike(() => page.evaluate(() => globalThis.saidSoFar.jobs), pattern, `a job like ${pattern}`);
}

/** @param {() => Promise<string[]>} ask @param {RegExp} pattern @param {string} what */
async function lastLike(ask, pattern, what) {
  const last = (/** @type {string[]} */ words) => words.findLast((text) => pattern.test(text));
  return /** @type {string} */ (last(await until(ask, (words) => last(words) !== undefined, what)));
}

/** The states of the cells: `Frame 1, femur: posed` and so on. @param {Page} page */
export async function cells(page) {
  const buttons = page.getByRole('table', { name: 'Frames and components' }).getByRole('button');
  return buttons.evaluateAll((all) => all.map((button) => button.getAttribute('aria-label') ?? ''));
}

/** @param {Page} page @param {string} name such as `Window width` */
export async function slider(page, name) {
  return Number(await page.getByRole('slider', { name, exact: true }).inputValue());
}

/** Window width and level as the sliders say them in words. @param {Page} page */
export async function windowAndLevel(page) {
  const texts = ['Window width', 'Window level'].map((name) =>
    page.getByRole('slider', { name, exact: true }).getAttribute('aria-valuetext'),
  );
  return (await Promise.all(texts)).map(Number);
}

/** Waits until frames are open. @param {Page} page @param {number} count */
export async function waitForFrames(page, count) {
  await page.getByRole('application', { name: new RegExp(`frame \\d+ of ${count}\\b`) }).waitFor();
}

/** @param {Page} page @param {'Femur' | 'Tibia'} component */
export function waitForLibrary(page, component) {
  return page.getByRole('button', { name: new RegExp(`^${component}: \\S+$`) }).waitFor();
}

/** Waits until libraries have been built. @param {Page} page @param {...('Femur' | 'Tibia')} components */
export async function waitForLibraries(page, ...components) {
  for (const component of components) await waitForLibrary(page, component);
  await until(() => page.getByRole('progressbar').count(), (count) => count === 0, 'no work to be under way');
}

/** @param {Page} page @param {number} [frames] see [`shorten`] */
export async function openDemonstration(page, frames = DEMONSTRATED) {
  if (frames < DEMONSTRATED) await shorten(page, frames);
  await page.getByRole('button', { name: 'Open the demonstration' }).click();
  await waitForFrames(page, frames);
}

/**
 * The demonstration, once it is opened, has so many frames, the first of its own: a film is followed in half of the time, and every stage has something to do.
 *
 * @param {Page} page
 * @param {number} frames
 */
export async function shorten(page, frames) {
  const manifest = JSON.parse((await demoFile('demo.json')).buffer.toString());
  const json = { ...manifest, frames: manifest.frames.slice(0, frames) };
  let isShortened = false;
  // The route stays: where the last one goes the browser lets go of what is under way, and a request beside it may wait for ever.
  await page.route(`${ADDRESS}demo/demo.json`, (route) => {
    if (isShortened) return route.continue();
    isShortened = true;
    return route.fulfill({ json });
  });
}

/** Waits until the last change is kept in the browser. @param {Page} page */
export async function waitUntilKept(page) {
  await drawn(page);
  const shown = () => page.getByRole('group', { name: 'Saved state' }).innerText();
  await until(shown, (text) => text.startsWith('Saved'), 'the work to be kept');
}
