/** What has to come before somebody can trace, and what has to wait until it is wanted. */
import assert from 'node:assert/strict';
import { pageTest, step } from './support/browser.mjs';
import { firstLoadOf, isOfFrames, pathOfTracing, total } from './support/loading.mjs';

/** Compressed, everything that comes before outlines can be traced: bytes do not depend on the machine. */
const BUDGET = 300_000;

pageTest('the first load', async (page, t) => {
  /** @type {import('./support/loading.mjs').Loaded[]} */
  let empty = [];
  await step(page, t, 'stays within the budget', async (t) => {
    empty = await firstLoadOf(page);
    tell(t, empty);
    assert(total(empty) < BUDGET, `${total(empty)} bytes`);
  });
  await step(page, t, 'brings neither decoders nor frames nor the view in space', async () => {
    const names = empty.map(({ path }) => path);
    assert(names.some((name) => name.endsWith('.wasm')), `the core is among ${names.join(', ')}`);
    assert.deepEqual(names.filter((name) => isOfFrames(name) || /three|space/.test(name)), []);
  });
  await step(page, t, 'leaves the workers that build libraries and find poses for when there is a model', async (t) => {
    assert.deepEqual(empty.filter(({ path }) => /pose-|library-/.test(path)), []);
    const files = await pathOfTracing(page, empty);
    tell(t, files);
    assert(files.some(({ path }) => /pose-/.test(path)) && files.some(({ path }) => /library-/.test(path)), 'both workers were seen');
  });
}, { builds: true });

/** @param {import('node:test').TestContext} t @param {import('./support/loading.mjs').Loaded[]} files */
function tell(t, files) {
  for (const { path, bytes } of files) t.diagnostic(`${bytes} ${path || 'index.html'}`);
  t.diagnostic(`${total(files)} bytes compressed`);
}
