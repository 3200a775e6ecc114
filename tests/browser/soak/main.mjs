/** Random work in one page for as long as one likes, and what it holds in memory: `cargo xtask soak` starts it. */
import assert from 'node:assert/strict';
import { argv, exit } from 'node:process';
import { atRest, browser, openWindow, visit, watch } from '../support/browser.mjs';
import { MemoryOf } from '../support/memory.mjs';
import { randomOf } from '../support/random.mjs';
import * as tracing from '../support/tracing.mjs';
import { RandomWork } from './work.mjs';

/** @typedef {import('../support/memory.mjs').Memory} Memory */

const [, , minutes = '30', seed = '1'] = argv;
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
const work = new RandomWork(page, await page.context().newPage(), random);
await page.bringToFront();
/** @type {Record<string, number>} */
const done = {};
/** @type {{ ms: number, passes: number, held: Memory }[]} */
const looks = [];
/** How often everything was done, and what is left of that which is being done. */
let passes = 0;
/** @type {string[]} */
let left = [];

await visit(page);
await tracing.openDemonstration(page);
console.log('minute  pass   page MB  buffers MB  workers MB  of  WASM MB  nodes  listeners');
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
  if (left.length === 0) left = Object.keys(work.kinds);
  const [name] = left.splice(Math.floor(random() * left.length), 1);
  done[name] = (done[name] ?? 0) + 1;
  try {
    await work.kinds[name]();
    if (left.length === 0) passes++;
  } catch (error) {
    console.log(`${name}: ${error instanceof Error ? error.message : error}`);
    throw error;
  }
}

/** The same state each time: a new work with the demonstration, and its libraries. */
async function look() {
  await work.open();
  await atRest(page);
  const held = await memory.now();
  const ms = since();
  looks.push({ ms, passes, held });
  const mega = (/** @type {number} */ bytes) => (bytes / 1e6).toFixed(2);
  /** @type {readonly (readonly [string | number, number])[]} */
  const cells = [[(ms / 60_000).toFixed(1), 6], [passes, 6], [mega(held.page), 10], [mega(held.buffers), 12], [mega(held.workers), 12], [held.count, 4], [mega(held.wasm), 9], [held.nodes, 7], [held.listeners, 11]];
  console.log(cells.map(([value, width]) => String(value).padStart(width)).join(''));
}

/** At the end no more than when it had settled, in each part. */
function isFlat() {
  const settled = looks.find(({ ms, passes }) => ms >= SETTLED.ms && passes >= SETTLED.passes);
  const last = looks.at(-1);
  if (!settled || !last || settled === last) {
    console.log(`not told: everything was done ${passes} times; let it work longer`);
    return false;
  }
  for (const name of Object.keys(last.held.parts)) {
    const [before, after] = [settled, last].map(({ held }) => held.parts[name]);
    if (before && after) console.log(`  ${name}: WASM ${(before.wasm / 1e6).toFixed(2)} and ${(after.wasm / 1e6).toFixed(2)} MB, heap ${(before.heap / 1e6).toFixed(2)} and ${(after.heap / 1e6).toFixed(2)}`);
  }
  const parts = /** @type {const} */ (['page', 'workers', 'wasm']);
  const told = parts.map((part) => {
    const [before, after] = [settled.held[part], last.held[part]];
    const percent = (100 * (after - before)) / before;
    console.log(`${part}: ${(before / 1e6).toFixed(2)} MB at ${(settled.ms / 60_000).toFixed(1)} minutes, ${(after / 1e6).toFixed(2)} MB at ${(last.ms / 60_000).toFixed(1)}: ${percent.toFixed(1)} %`);
    return after <= MOST * before;
  });
  return told.every((flat) => flat);
}
