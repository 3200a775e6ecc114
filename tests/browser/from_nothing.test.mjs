/**
 * The page's workers and the command look for the same, in the same frames and order, where nobody points at anything, find it in the
 * same places, and say the same of each frame. The film is drawn here, so that it is small; the command keeps in its journal what each search led to.
 */
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdir, mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { promisify } from 'node:util';
import { decode, encode } from 'fast-png';
import { IN_FIREFOX, PATIENCE, pageTest, screenshot, setting } from './support/browser.mjs';
import { choose, file } from './support/files.mjs';
import * as panel from './support/panel.mjs';
import { demoFile } from './support/study.mjs';

const SIDE = 512;
const FRAMES = 2;
const CALIBRATION = 'JT_INTCALIB\n1200\n0\n0\n0.746\n';
const STUDY = "name = 'drawn'\nside = 'left'\ncalibration = 'calibration.txt'\nframes = 'frames'\n[[component]]\nname = 'femur'\nmodel = 'femur.stl'\n[[component]]\nname = 'tibia'\nmodel = 'tibia.stl'\n";
/** How much darker each component is than what surrounds it. */
const PARTS = /** @type {const} */ ([['femur', 120], ['tibia', 70]]);
/** Of numbers of rotation matrices, and mm: poses cross into JavaScript as angles. */
const SAME = 1e-6;

/** @typedef {{ kind: string, part: number, frame: number, pose: number[] | null }} Searched numbers of the matrix row by row, then of the shift */

test('page and command find the same from nothing', { timeout: 3 * PATIENCE }, async (t) => {
  const { frames, written } = await trackedFilm();
  const byCommand = searchedByCommand(written);
  const inWorkers = await searchedInWorkers(frames);
  t.diagnostic(byCommand.map(({ kind, part, frame, pose }) => `${kind} ${part} in frame ${frame}: ${pose ? 'found' : 'nothing'}`).join(', '));
  const order = (/** @type {Searched[]} */ all) => all.map(({ kind, part, frame, pose }) => [kind, part, frame, pose !== null]);
  assert.deepEqual(order(inWorkers), order(byCommand));
  assert.deepEqual(byCommand.map(({ kind, part, pose }) => [kind, part, pose !== null]), [['search', 0, true], ['joint', 1, true]]);
  inWorkers.forEach(({ pose }, at) => pose?.forEach((number, k) => assert(Math.abs(number - (byCommand[at]?.pose?.[k] ?? NaN)) < SAME, `number ${k} of search ${at}`)));
});

if (!IN_FIREFOX) {
  pageTest('page and command trust the same frames, from nothing', async (page, t) => {
    const { frames, written: { table } } = await trackedFilm();
    const rows = table.trim().split('\n').slice(1).map((line) => line.replaceAll('"', '').split(','));
    const byCommand = rows.map(([frame, component, , verdict]) => `frame ${frame}, ${component}: ${verdict}`);
    const pictures = frames.map((data, number) => file(`${number}.png`, pictureOf(data)));
    const models = await Promise.all(PARTS.map(([name]) => demoFile(`${name}.stl`)));
    await choose(page, ...pictures, file('calibration.txt', CALIBRATION), ...models);
    await panel.waitForFrames(page, FRAMES);
    await panel.waitForLibraries(page, 'Femur', 'Tibia');
    await page.keyboard.press('Shift+G');
    await panel.waitForWords(page, /^\d+ poses? found/);
    const said = (/** @type {string} */ cell) => (/doubtful/.test(cell) ? 'doubtful' : /: (posed|followed)/.test(cell) ? 'good' : 'none');
    const inPage = (await panel.cells(page)).map((cell) => `${/^Frame \d+, \w+/.exec(cell)?.[0].toLowerCase()}: ${said(cell)}`);
    t.diagnostic(byCommand.join('; '));
    await screenshot(page, 'from nothing');
    assert.deepEqual(inPage.toSorted(), byCommand.toSorted());
    // Nothing is left to be followed: neither what led nor the film has changed since.
    await page.keyboard.press('Shift+G');
    await panel.waitForWords(page, /^Every frame is followed already/);
  });
}

/** @type {ReturnType<typeof drawnAndTracked> | undefined} */
let drawnOnce;

/** The film, and what the command writes of it: once for all tests. */
function trackedFilm() {
  return (drawnOnce ??= drawnAndTracked());
}

async function drawnAndTracked() {
  const frames = await Promise.all(Array.from({ length: FRAMES }, (_, frame) => drawn(frame)));
  return { frames, written: await tracked(frames) };
}

/** @param {Uint8Array} data */
function pictureOf(data) {
  return encode({ width: SIDE, height: SIDE, data, channels: 1, depth: 8 });
}

/** Half as large as the demonstration's masks, with a little noise. @param {number} number */
async function drawn(number) {
  const grey = new Float64Array(SIDE * SIDE).fill(200);
  for (const [name, darker] of PARTS) {
    const { data } = decode((await demoFile(`masks/${name}/${String(number + 1).padStart(4, '0')}.png`)).buffer);
    data.forEach((value, at) => {
      const [column, row] = [at % (2 * SIDE), Math.floor(at / (2 * SIDE))];
      if (value > 0) grey[(row >> 1) * SIDE + (column >> 1)] -= darker / 4;
    });
  }
  let seed = number + 1;
  return Uint8Array.from(grey, (value) => value + ((seed = (seed * 1_103_515_245 + 12_345) % 2_147_483_648) / 2_147_483_648 - 0.5) * 6);
}

/** What the command writes. @param {Uint8Array[]} frames */
async function tracked(frames) {
  const folder = await mkdtemp(join(tmpdir(), 'fluoropose-from-nothing-'));
  try {
    await mkdir(join(folder, 'frames'));
    for (const [number, data] of frames.entries()) await writeFile(join(folder, 'frames', `${number}.png`), pictureOf(data));
    for (const [name] of PARTS) await writeFile(join(folder, `${name}.stl`), (await demoFile(`${name}.stl`)).buffer);
    await writeFile(join(folder, 'calibration.txt'), CALIBRATION);
    await writeFile(join(folder, 'study.toml'), STUDY);
    const words = ['track', '--study', join(folder, 'study.toml'), '--out', join(folder, 'out')];
    // It exits with 3 where no pose is good.
    await promisify(execFile)(setting('FLUOROPOSE_LABORATORY'), words).catch((error) => assert.equal(error.code, 3, error.stderr));
    const [journal, table] = await Promise.all(['journal.txt', 'track.csv'].map((name) => readFile(join(folder, 'out', name), 'utf8')));
    return { journal: journal ?? '', table: table ?? '' };
  } finally {
    await rm(folder, { recursive: true });
  }
}

/** @param {{ journal: string }} written @returns {Searched[]} */
function searchedByCommand({ journal }) {
  return journal.split('\n').flatMap((line) => {
    const [key = '', ...numbers] = line.split(' ');
    const [kind = '', part, phase, frame] = key.split('/');
    const pose = numbers.length > 0 ? numbers.slice(0, 12).map(numberOf) : null;
    return phase === 'bare' && (kind === 'search' || kind === 'joint') ? [{ kind, part: Number(part), frame: Number(frame), pose }] : [];
  });
}

/** A number by its bits. @param {string} hexadecimal */
function numberOf(hexadecimal) {
  const view = new DataView(new ArrayBuffer(8));
  view.setBigUint64(0, BigInt(`0x${hexadecimal}`));
  return view.getFloat64(0);
}

/** As `web/src/workers/handlers/first_poses.ts` does it. @param {Uint8Array[]} frames @returns {Promise<Searched[]>} */
async function searchedInWorkers(frames) {
  const from = (/** @type {string} */ path) => import(pathToFileURL(join(setting('FLUOROPOSE_PACKAGE'), 'npm', path)).href);
  const { openImplant } = await from('node.js');
  const { decodeModel } = await from('decode.js');
  const core = await from('pkg/core/fluoropose_wasm.js');
  const opened = await Promise.all(PARTS.map(async ([name]) => {
    const { buffer: model } = await demoFile(`${name}.stl`);
    const implant = await openImplant({ model, calibration: CALIBRATION, frame: { width: SIDE, height: SIDE } });
    const { mesh: { vertices, triangles } } = await decodeModel(new Uint8Array(model));
    return { library: implant.library, vertices, triangles, axes: core.shapeAxes(vertices, triangles, name === 'femur') };
  }));
  const plan = new core.SearchPlan(FRAMES, false);
  const searches = opened.map(({ library, vertices, triangles, axes }, part) => {
    const other = opened[1 - part];
    const search = new core.FrameSearch(library, vertices, triangles, CALIBRATION, SIDE, SIDE);
    search.knowLimb(part === 0, axes.directions, axes.told === 'all');
    search.knowOther(other.vertices, other.triangles, other.axes.directions, other.axes.told === 'all');
    plan.add(part === 0, true, ...middleOf(vertices));
    return search;
  });
  const images = frames.map((pixels) => core.FrameImage.fromEightBit(pixels, SIDE, SIDE));
  const done = [];
  for (let step = plan.wanted(); step; step = plan.wanted()) {
    const { part, frame, known, way } = step;
    const search = searches[part];
    search.showBright(way === 1);
    if (step.search === 'follow') {
      search.beginWalk(frame, known, FRAMES);
      for (let at = search.walkWanted(); at !== undefined; at = search.walkWanted()) search.walkTake(images[at]);
      plan.followed(search.walkEnds());
      continue;
    }
    search.beside(known ?? [], step.search === 'joint');
    for (let more = search.step(images[frame], true); more; more = search.step(images[frame], false));
    if (way === 0) done.push({ kind: step.search === 'joint' ? 'joint' : 'search', part, frame, pose: search.pose ? matrixOf(search.pose) : null });
    plan.found(search.pose, search.score ?? 0);
  }
  return done;
}

/** @param {Float32Array} vertices */
function middleOf(vertices) {
  return [0, 1, 2].map((axis) => {
    const along = vertices.filter((_, at) => at % 3 === axis);
    return (along.reduce((a, b) => Math.min(a, b)) + along.reduce((a, b) => Math.max(a, b))) / 2;
  });
}

/** Rz Rx Ry row by row, and the shift. @param {Float64Array} pose */
function matrixOf([x = 0, y = 0, z = 0, ...angles]) {
  const [[sz, cz], [sx, cx], [sy, cy]] = angles.map((degrees) => [Math.sin((degrees * Math.PI) / 180), Math.cos((degrees * Math.PI) / 180)]);
  return [cz * cy - sz * sx * sy, -sz * cx, cz * sy + sz * sx * cy, sz * cy + cz * sx * sy, cz * cx, sz * sy - cz * sx * cy, -cx * sy, sx, cx * cy, x, y, z];
}
