/** A few of the trials of `cargo xtask kill`, so that the verb itself does not decay: what was shown as saved comes back, and what was lost would be told. */
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { IN_FIREFOX, PATIENCE } from './support/browser.mjs';
import { emptyRow, trial } from './kills/trial.mjs';

/** A crash, and a storage that is gone. */
const SAMPLE = ['tab crashes', 'storage is evicted'];

for (const [index, name] of SAMPLE.entries()) {
  test(`work is ended: ${name}`, { skip: IN_FIREFOX && 'Firefox has no such protocol', timeout: 3 * PATIENCE }, async () => {
    const row = emptyRow();
    await trial(name, index, 1, row);
    const { trials, lost, undecided } = row;
    assert.deepEqual({ trials, lost, undecided }, { trials: 1, lost: 0, undecided: 0 });
    assert(row.edits > 0, 'there was work to lose');
  });
}
