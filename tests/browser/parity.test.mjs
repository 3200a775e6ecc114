/**
 * The npm module finds what the native program finds, to the last bit. `tests/snapshots/parity.json` is what that found,
 * written and checked by `tests/tests/all/parity.rs`.
 */
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { PATIENCE, setting } from './support/browser.mjs';
import { demoFile } from './support/study.mjs';

/**
 * @typedef {{ name: string, model: string, outline: [number, number][], verdict: string, because: string, chosen: number,
 *   candidates: number[][] }} Case numbers of a pose as in a `.jts` file
 * @typedef {{ calibration: string, side: number, libraries: Record<string, string>, cases: Case[] }} Native
 */

const SNAPSHOT = new URL('../snapshots/parity.json', import.meta.url);

test('the npm module finds what the native program finds', { timeout: 3 * PATIENCE }, async (t) => {
  /** @type {Native} */
  const native = JSON.parse(await readFile(SNAPSHOT, 'utf8'));
  const from = (/** @type {string} */ path) => import(pathToFileURL(join(setting('FLUOROPOSE_PACKAGE'), 'npm', path)).href);
  const { openImplant } = await from('node.js');
  const core = await from('pkg/core/fluoropose_wasm.js');
  const frame = { width: native.side, height: native.side };
  for (const [name, digest] of Object.entries(native.libraries)) {
    const { buffer: model } = await demoFile(`${name}.stl`);
    const implant = await openImplant({ model, calibration: native.calibration, frame });
    await t.test(`the library of the ${name}`, () => assert.equal(createHash('sha256').update(implant.library).digest('hex'), digest));
    const matcher = new core.Matcher(implant.library);
    matcher.takeModel(...(await meshOf(from, model)));
    for (const wanted of native.cases.filter(({ model }) => model === name)) {
      await t.test(`${name}: ${wanted.name}`, () => {
        // What does not fit takes seconds each time.
        if (wanted.verdict === 'none') return isRefused(implant, wanted);
        sameMatch(core, matcher, native, wanted);
        if (wanted.verdict === 'good') samePose(implant, wanted);
      });
    }
    matcher.free();
    implant.close();
  }
});

/** What the page reads: how many poses there are, which is chosen, and how far it is to be trusted. @param {any} core @param {any} matcher @param {Native} native @param {Case} wanted */
function sameMatch(core, matcher, { calibration, side }, wanted) {
  const traced = new core.Traced(Float64Array.from(wanted.outline.flat()), new Uint32Array(), calibration, side, side);
  const around = new core.Surroundings();
  const match = matcher.refineOutline(traced, around);
  assert.equal(match.compared, wanted.candidates.length);
  assert.deepEqual([match.verdict, match.because], [wanted.verdict, wanted.because]);
  assert.deepEqual(Array.from(match.pose(0)), wanted.candidates[wanted.chosen]);
  for (let rival = 1; rival < match.count; rival++) {
    const pose = Array.from(match.pose(rival));
    assert(wanted.candidates.some((other) => pose.every((value, at) => value === other[at])), `rival ${rival}: ${pose.join(', ')}`);
  }
  for (const held of [match, around, traced]) held.free();
}

/** What other programs read. @param {any} implant @param {Case} wanted */
function samePose(implant, { outline, verdict: word, because, chosen, candidates }) {
  const { pose, verdict } = implant.pose(outline);
  assert.deepEqual([pose.x, pose.y, pose.z, pose.zRot, pose.xRot, pose.yRot], candidates[chosen]);
  assert.deepEqual(verdict, { word, because });
}

/** The sentence has figures of the best pose. @param {any} implant @param {Case} wanted */
function isRefused(implant, { outline, because }) {
  const sentence = because.charAt(0).toUpperCase() + because.slice(1);
  assert.throws(() => implant.pose(outline), new Error(sentence));
}

/** @param {(path: string) => Promise<any>} from @param {Buffer} model */
async function meshOf(from, model) {
  const { vertices, triangles } = await (await from('decode.js')).decodeModel(new Uint8Array(model));
  return [vertices, triangles];
}
