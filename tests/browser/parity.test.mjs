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
 * @typedef {{ model: string, outline: [number, number][], given: number[], pose: number[], words: string, constants: number[],
 *   corrected: number[], soft: { reach: number, words: string, pose: number[] } }} OnFrame
 * @typedef {{ calibration: string, side: number, libraries: Record<string, string>, cases: Case[], image: OnFrame }} Native
 */

const SNAPSHOT = new URL('../snapshots/parity.json', import.meta.url);

test('the npm module finds what the native program finds', { timeout: 3 * PATIENCE }, async (t) => {
  /** @type {Native} */
  const native = JSON.parse(await readFile(SNAPSHOT, 'utf8'));
  const from = (/** @type {string} */ path) => import(pathToFileURL(join(setting('FLUOROPOSE_PACKAGE'), 'npm', path)).href);
  const { openImplant } = await from('node.js');
  const core = await from('pkg/core/fluoropose_wasm.js');
  const frame = { width: native.side, height: native.side };
  /** @type {Record<string, any>} */
  const opened = {};
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
    if (name === native.image.model) {
      const module = await from('node.js');
      await t.test(`${name}: on a grey frame, by its film`, () => onFrame(core, matcher, implant, module.estimateFilm, native));
      await t.test(`${name}: on a soft frame, whose film is read in squares`, () => onSoftFrame(core, implant, module.estimateFilm, native));
    }
    matcher.free();
    opened[name] = implant;
  }
  await t.test('the other component tells what no knee does', () => besideTheFemur(opened, native));
  for (const implant of Object.values(opened)) implant.close();
});

/** A femur as the tray lies, and turned by a right angle; the built-in files have the field's axes, and so their shapes tell. @param {Record<string, any>} opened @param {Native} native */
function besideTheFemur({ femur, tibia }, { cases }) {
  const { outline, chosen, candidates } = /** @type {Case} */ (cases.find(({ model, verdict }) => model === 'tibia' && verdict !== 'none'));
  const [x, y, z, zRot, xRot, yRot] = /** @type {number[]} */ (candidates[chosen]);
  const beside = (/** @type {number} */ turn) => ({ x, y, z, zRot, xRot, yRot: Number(yRot) + turn });
  for (const hint of [beside(0), { implant: femur, pose: beside(0) }]) assert.equal(tibia.pose(outline, { femur: hint }).verdict.word, 'good');
  for (const hint of [beside(90), { implant: femur, pose: beside(90) }]) {
    const { verdict } = tibia.pose(outline, { femur: hint });
    assert.equal(verdict.word, 'doubtful');
    assert.match(verdict.because, /mediolateral axis is (8[5-9]|90)° from the other component's, which no knee does/);
  }
}

/** Drawn as the native program draws it: dark by how many of the pixels round each lie inside. @param {any} core @param {Native} native @param {number} reach */
function frameOf(core, { side, image }, reach) {
  const mask = core.maskOfOutline(Float64Array.from(image.outline.flat()), side, side);
  return Uint8Array.from(mask, (/** @type {number} */ _, /** @type {number} */ number) => {
    const [column, row] = [number % side, Math.floor(number / side)];
    let covered = 0;
    for (let down = Math.max(0, row - reach); down <= Math.min(side - 1, row + reach); down++) {
      for (let right = Math.max(0, column - reach); right <= Math.min(side - 1, column + reach); right++) covered += mask[down * side + right];
    }
    return 210 - Math.floor((150 * covered) / (2 * reach + 1) ** 2);
  });
}

/** The film given, the film estimated, and the pose by either. @param {any} core @param {any} matcher @param {any} implant @param {any} estimateFilm @param {Native} native */
function onFrame(core, matcher, implant, estimateFilm, native) {
  const { calibration, side, image: wanted } = native;
  const pixels = frameOf(core, native, 2);
  const [curvature, blur, attenuation] = wanted.given;
  const { pose } = implant.pose(wanted.outline, { image: pixels, film: { curvature, blur, attenuation } });
  assert.deepEqual([pose.x, pose.y, pose.z, pose.zRot, pose.xRot, pose.yRot], wanted.pose);
  const film = estimateFilm([{ implant, image: pixels, pose }]);
  assert.equal(film.words, wanted.words);
  const model = film.models.get(implant);
  assert.deepEqual(model.slice(0, 3), wanted.constants);
  // What the page does with a pose that was found before.
  const [frame, hidden] = [core.FrameImage.fromEightBit(pixels, side, side), new core.HiddenPixels(calibration, side, side)];
  const answer = matcher.correctOnFrame(frame, hidden, Float64Array.from(wanted.pose), Float64Array.of(1), 0, Float64Array.from(model));
  const match = answer.takeMatch();
  assert.deepEqual(Array.from(match.pose(0)), wanted.corrected);
  for (const held of [match, answer, hidden, frame]) held.free();
}

/** A frame whose film is read in squares of pixels. @param {any} core @param {any} implant @param {any} estimateFilm @param {Native} native */
function onSoftFrame(core, implant, estimateFilm, native) {
  const { outline, soft } = native.image;
  const pixels = frameOf(core, native, soft.reach);
  const film = estimateFilm([{ implant, image: pixels, pose: implant.pose(outline, { image: pixels }).candidates[0].pose }]);
  assert.equal(film.words, soft.words);
  const [{ pose }] = implant.pose(outline, { image: pixels, film }).candidates;
  assert.deepEqual([pose.x, pose.y, pose.z, pose.zRot, pose.xRot, pose.yRot], soft.pose);
}

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
  const { mesh: { vertices, triangles } } = await (await from('decode.js')).decodeModel(new Uint8Array(model));
  return [vertices, triangles];
}
