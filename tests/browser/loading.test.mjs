/** What has to come before somebody can trace, and what has to wait until it is wanted. */
import assert from 'node:assert/strict';
import { pageTest, step } from './support/browser.mjs';
import { firstLoadOf, isOfFrames, pathOfTracing, total } from './support/loading.mjs';

/** Compressed, all that tracing needs: bytes do not depend on the machine. */
const BUDGET = 300_000;

pageTest('the first load', async (page, t) => {
  /** @type {import('./support/loading.mjs').Loaded[]} */
  let empty = [];
  await step(page, t, 'brings neither decoders nor frames nor the view in space', async () => {
    empty = await firstLoadOf(page);
    const names = empty.map(({ path }) => path);
    assert(names.some((name) => name.endsWith('.wasm')), `the core is among ${names.join(', ')}`);
    assert.deepEqual(names.filter((name) => isOfFrames(name) || /three|space/.test(name)), []);
  });
  await step(page, t, 'and the workers that trace and pose stay within the budget', async (t) => {
    const files = await pathOfTracing(page, empty);
    for (const { path, bytes } of files) t.diagnostic(`${bytes} ${path || 'index.html'}`);
    t.diagnostic(`${total(files)} bytes compressed`);
    assert(files.some(({ path }) => /pose/.test(path)) && files.some(({ path }) => /library/.test(path)), 'both workers were seen');
    assert(total(files) < BUDGET, `${total(files)} bytes`);
  });
});
