/** Random work in one page for as long as one likes, and what it holds in memory: `cargo xtask soak` starts it. */
import assert from 'node:assert/strict';
import { argv, exit } from 'node:process';
import { atRest, browser, openWindow, until, visit, watch } from '../support/browser.mjs';
import { exportSheet, openExport, savedFile } from '../support/exporting.mjs';
import { MemoryOf } from '../support/memory.mjs';
import * as panel from '../support/panel.mjs';
import { Stage } from '../support/stage.mjs';
import { trueOutline } from '../support/study.mjs';
import * as tracing from '../support/tracing.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('../support/memory.mjs').Memory} Memory */
/** @typedef {'femur' | 'tibia'} Component */

const [, , minutes = '30', seed = '1'] = argv;
const FRAMES = 8;
const COMPONENTS = /** @type {const} */ (['femur', 'tibia']);
/** After so long, and as often as everything was done, what is held is compared with what is held at the end: memory of WebAssembly never shrinks. */
const SETTLED = { ms: 5 * 60_000, passes: 3 };
/** Between looks at the memory. */
const LOOK_MS = 60_000;
/** By so much it may be more at the end. */
const MOST = 1.05;

const random = randomOf(Number(seed));
const started = Date.now();
const since = () => Date.now() - started;
const page = await openWindow({ serviceWorkers: 'block', acceptDownloads: true });
const troubles = watch(page);
const memory = await MemoryOf.of(page);
/** It is loaded anew again and again. */
const other = await page.context().newPage();
await page.bringToFront();
/** @type {Record<string, number>} */
const done = {};
/** @type {{ ms: number, passes: number, held: Memory }[]} */
const looks = [];
/** How often everything was done, and what is left of that which is being done. */
let passes = 0;
/** @type {string[]} */
let left = [];
/** @type {Record<string, () => Promise<void>>} */
const KINDS = { click, drag, follow, undo, export: save, reload, open };

await visit(page);
await tracing.openDemonstration(page);
console.log('minute  pass   page MB  workers MB  of  WASM MB');
await look();
while (since() < Number(minutes) * 60_000) {
  await round();
  if (since() - (looks.at(-1)?.ms ?? 0) > LOOK_MS) await look();
}
await look();
await (await browser()).close();
console.log(Object.entries(done).map(([name, count]) => `${name} ${count}`).join(', '));
assert.deepEqual(troubles, [], 'the page threw, logged an error, or asked another computer');
exit(isFlat() ? 0 : 1);

/** Some random work, of which all is undone or left behind. */
async function round() {
  if (left.length === 0) left = Object.keys(KINDS);
  const [name] = left.splice(Math.floor(random() * left.length), 1);
  done[name] = (done[name] ?? 0) + 1;
  try {
    await KINDS[name]();
    if (left.length === 0) passes++;
  } catch (error) {
    console.log(`${name}: ${error instanceof Error ? error.message : error}`);
    throw error;
  }
}

/** The same state each time: a new work with the demonstration, and its libraries. */
async function look() {
  await open();
  await atRest(page);
  looks.push({ ms: since(), passes, held: await memory.now() });
  const { ms, held } = looks.at(-1) ?? assert.fail();
  const mega = (/** @type {number} */ bytes) => (bytes / 1e6).toFixed(2);
  console.log(`${(ms / 60_000).toFixed(1).padStart(6)}${String(passes).padStart(6)}${mega(held.page).padStart(10)}${mega(held.workers).padStart(12)}${String(held.count).padStart(4)}${mega(held.wasm).padStart(9)}`);
}

/** At the end no more than when it had settled, in each part. */
function isFlat() {
  const settled = looks.find(({ ms, passes }) => ms >= SETTLED.ms && passes >= SETTLED.passes);
  if (!settled || settled === looks.at(-1)) {
    console.log(`not told: everything was done ${passes} times; let it work longer`);
    return false;
  }
  const last = looks.at(-1) ?? settled;
  const parts = /** @type {const} */ (['page', 'workers', 'wasm']);
  const told = parts.map((part) => {
    const [before, after] = [settled.held[part], last.held[part]];
    const percent = (100 * (after - before)) / before;
    console.log(`${part}: ${(before / 1e6).toFixed(2)} MB at ${(settled.ms / 60_000).toFixed(1)} minutes, ${(after / 1e6).toFixed(2)} MB at ${(last.ms / 60_000).toFixed(1)}: ${percent.toFixed(1)} %`);
    return after <= MOST * before;
  });
  return told.every((flat) => flat);
}

/** A new work. Earlier ones stay. */
async function open() {
  await page.keyboard.press('Escape');
  await page.keyboard.press('Shift+Alt+n');
  await tracing.openDemonstration(page);
}

/** One click into a component of some frame. */
async function click() {
  const component = COMPONENTS[Math.floor(random() * 2)];
  const frame = 1 + Math.floor(random() * FRAMES);
  await page.getByRole('slider', { name: 'Frame', exact: true }).fill(String(frame - 1));
  await page.getByRole('radio', { name: component === 'femur' ? 'Femur' : 'Tibia' }).click();
  await page.keyboard.press('o');
  await atRest(page);
  const stage = new Stage(page);
  await stage.learn();
  await stage.click(tracing.insideOf(await trueOutline(component, frame)));
  await atRest(page);
}

/** A point of a traced outline, along and back. */
async function drag() {
  await page.getByRole('slider', { name: 'Frame', exact: true }).fill('0');
  await page.getByRole('radio', { name: 'Femur' }).click();
  const stage = new Stage(page);
  const outline = await trueOutline('femur', 1);
  const isOpen = (await panel.cells(page)).some((cell) => /^Frame 1, femur: empty/.test(cell));
  await stage.learn();
  if (isOpen) await stage.trace(outline);
  await page.keyboard.press('e');
  await stage.learn();
  const [column, row] = outline[Math.floor(random() * outline.length)];
  await stage.drag([column, row], [column + 6 * random() - 3, row + 6 * random() - 3]);
  await atRest(page);
}

async function follow() {
  const cells = await panel.cells(page);
  if (!cells.some((cell) => /: (posed|followed)/.test(cell))) await click();
  await page.keyboard.press('Shift+G');
  // Some are stopped on the way.
  if (random() < 0.3) {
    await page.waitForTimeout(1000 * random());
    await page.keyboard.press('Shift+G');
  }
  await until(() => page.getByRole('progressbar').count(), (count) => count === 0, 'the film to be followed');
  await atRest(page);
}

async function undo() {
  for (let step = Math.floor(8 * random()); step >= 0; step--) await page.keyboard.press('Control+z');
  await atRest(page);
  for (let step = Math.floor(3 * random()); step > 0; step--) await page.keyboard.press('Control+y');
  await atRest(page);
}

async function save() {
  const kinds = [['Session'], ['Poses', 'For commands'], ['Session', 'With images and models'], ['Session', 'Study file']];
  const [kind, ...choices] = kinds[Math.floor(random() * kinds.length)];
  const hasPoses = (await panel.cells(page)).some((cell) => /: (posed|followed)/.test(cell));
  if (kind === 'Poses' && !hasPoses) return;
  await openExport(page, kind, ...choices);
  await savedFile(page);
  // Who has saved a session is done; other files leave the sheet open.
  const sheet = exportSheet(page);
  if (await sheet.count()) await page.keyboard.press('Escape');
  await sheet.waitFor({ state: 'detached' });
}

/** Another page, which finds the work that is kept. */
async function reload() {
  await other.goto(page.url());
  await until(() => other.evaluate(() => 'fluoropose' in globalThis), (here) => here, 'the other page to start');
  await atRest(other);
  await other.goto('about:blank');
  await page.bringToFront();
}

/** Mulberry32. @param {number} from */
function randomOf(from) {
  let state = from >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}
