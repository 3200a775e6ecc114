/** Work that is done again needs no more memory than the first time: what is counted are pages of WebAssembly, workers, nodes and listeners. */
import assert from 'node:assert/strict';
import { isDeepStrictEqual } from 'node:util';
import { atRest, IN_FIREFOX, pageTest, until } from './support/browser.mjs';
import { MemoryOf } from './support/memory.mjs';
import { RandomWork } from './soak/work.mjs';
import * as tracing from './support/tracing.mjs';

/** @typedef {import('./support/memory.mjs').Memory} Memory */

if (!IN_FIREFOX) {
  pageTest('a work that is opened again and again', async (page, t) => {
    const memory = await MemoryOf.of(page);
    const work = new RandomWork(page, page, () => 0);
    await tracing.openDemonstration(page);
    await atRest(page);
    const first = pagesOf(await memory.now());
    await work.open();
    await atRest(page);
    const second = await settled(memory);
    await work.open();
    await atRest(page);
    const third = await settled(memory);
    t.diagnostic(JSON.stringify(pagesOf(third)));
    assert.deepEqual([pagesOf(second), pagesOf(third)], [first, first]);
    // The hint for who opens the first work is gone with it.
    assert.deepEqual(counts(third), counts(second));
  }, { builds: true });
}

/** What is let go may be collected later. @param {MemoryOf} memory */
async function settled(memory) {
  let before = await memory.now();
  const next = async () => {
    const now = await memory.now();
    const isSame = isDeepStrictEqual(counts(now), counts(before));
    before = now;
    return isSame;
  };
  await until(next, (isSame) => isSame, 'what is counted to stay the same');
  return before;
}

/** @param {Memory} memory */
function counts({ count, nodes, listeners }) {
  return { count, nodes, listeners };
}

/** Of 64 KiB. @param {Memory} memory */
function pagesOf({ parts }) {
  return Object.fromEntries(Object.entries(parts).map(([name, { wasm }]) => [name, wasm / 65_536]));
}
