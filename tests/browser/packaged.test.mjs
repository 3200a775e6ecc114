/** What `cargo xtask package` makes: the page in one file, opened from the disk, and the npm module. */
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { cp, mkdir, readFile, symlink, writeFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { promisify } from 'node:util';
import { openWindow, PATIENCE, setting, step, visit, watch } from './support/browser.mjs';
import { temporaryFolder } from './support/files.mjs';
import { Host } from './support/host.mjs';
import * as panel from './support/panel.mjs';
import { demoFile, HAND_TRACED, truePose } from './support/study.mjs';
import { fromOpeningToPose } from './support/workflow.mjs';

const run = promisify(execFile);
const EXAMPLE = fileURLToPath(new URL('../../web/npm/example/', import.meta.url));

test('the page in one file, from the disk', { timeout: 3 * PATIENCE }, async (t) => {
  const address = pathToFileURL(join(setting('FLUOROPOSE_PACKAGE'), 'fluoropose.html')).href;
  const page = await openWindow();
  const troubles = watch(page, address);
  await step(page, t, 'its policy allows its own script and style alone', async () => {
    await visit(page, address);
    const policy = (await page.locator('meta[http-equiv=Content-Security-Policy]').getAttribute('content')) ?? '';
    assert.match(policy, /^default-src 'none'; script-src 'sha256-\S+' 'wasm-unsafe-eval'; worker-src blob:; style-src 'sha256-\S+'; /);
    assert.doesNotMatch(policy, /unsafe-inline|'unsafe-eval'|'self'|https?:/);
  });
  await step(page, t, 'from opening to a pose', async () => void (await fromOpeningToPose(page)));
  await page.context().close();
  // A page from the disk that asked for another file there would be recorded too.
  assert.deepEqual(troubles, [], 'the page threw, logged an error, or asked for something');
});

test('the npm module', { timeout: 3 * PATIENCE }, async (t) => {
  const folder = await exampleFolder();
  const truth = await truePose('femur', 1);

  await t.test('its example runs in Node.js', async () => {
    const { stdout } = await run(process.execPath, ['trace_to_pose.mjs', 'femur.stl', 'calibration.txt', 'outline.json'], { cwd: folder });
    const { pose, deviations } = JSON.parse(stdout);
    panel.assertNear(pose, truth, HAND_TRACED);
    assert(Object.values(deviations).every((value) => value > 0), 'each number has its deviation');
  });

  await t.test('its example runs in a browser', async () => {
    const host = await new Host(folder, '/').start();
    const page = await openWindow();
    const troubles = watch(page, host.address);
    await page.goto(`${host.address}viewer.html`);
    for (const [label, name] of [['Model', 'femur.stl'], ['Calibration', 'calibration.txt'], ['Outline', 'outline.json']]) {
      await page.getByLabel(label).setInputFiles(join(folder, name));
    }
    await page.getByRole('button', { name: 'Find the pose' }).click();
    const answer = page.getByRole('status').filter({ hasText: 'zRot' });
    panel.assertNear(JSON.parse(await answer.innerText()), truth, HAND_TRACED);
    await page.context().close();
    assert.deepEqual(troubles, []);
  });

  await t.test('a file that is no model is told in a sentence', async () => {
    const mistaken = ['trace_to_pose.mjs', 'calibration.txt', 'calibration.txt', 'outline.json'];
    await assert.rejects(run(process.execPath, mistaken, { cwd: folder }), /Error: the model/);
  });

  await t.test('what is unusual of model and camera is told', async () => {
    const { openImplant } = await import(pathToFileURL(join(folder, 'node_modules/fluoropose/node.js')).href);
    const [model, calibration] = [await readFile(join(folder, 'femur.stl')), await readFile(join(folder, 'calibration.txt'), 'utf8')];
    const opened = async (/** @type {Buffer} */ model, /** @type {string} */ calibration) => {
      const femur = await openImplant({ model, calibration, frame: { width: 1024, height: 1024 }, views: { x: [0, 1, 1], y: [0, 1, 1] } });
      femur.close();
      return femur.remarks;
    };
    assert.deepEqual(await opened(model, calibration), []);
    const [size, ...camera] = await opened(inCentimetres(model), 'JT_INTCALIB\n1198\n-200\n200\n0.4\n');
    assert.match(size, /^model: the model is .* no knee component's size in millimetres: is the file in centimetres or inches\?/);
    assert.match(camera.join(), /^camera: the principal point, column 12\.0 and row 12\.0, lies far from the middle of a frame of 1024 x 1024 pixels/);
  });

  await t.test('an image that is none, and calls after close, are told in sentences', async () => {
    const { openImplant, estimateFilm } = await import(pathToFileURL(join(folder, 'node_modules/fluoropose/node.js')).href);
    const { frame, outline } = JSON.parse(await readFile(join(folder, 'outline.json'), 'utf8'));
    const [model, calibration] = [await readFile(join(folder, 'femur.stl')), await readFile(join(folder, 'calibration.txt'), 'utf8')];
    const femur = await openImplant({ model, calibration, frame, views: { x: [0, 1, 1], y: [0, 1, 1] } });
    const pixels = frame.width * frame.height;
    const random = Float32Array.from({ length: pixels }, (_, pixel) => (pixel * 7919) % 251);
    const wrong = /** @type {const} */ ([
      [random, /image is of type Float32Array; .* Uint8Array \(8 bits\) or a Uint16Array/],
      [new Float32Array(pixels), /type Float32Array/],
      [new Uint8ClampedArray(4 * pixels), /type Uint8ClampedArray/],
      [Array.from(random), /type Array/],
      [Uint8Array.from(random).subarray(1), new RegExp(`image has ${pixels - 1} values, and a frame of 1024 x 1024 pixels has ${pixels}`)],
      [new Uint16Array(pixels).fill(7), /image has the grey value 7 everywhere/],
    ]);
    for (const [image, sentence] of wrong) {
      assert.throws(() => femur.pose(outline, { image }), sentence);
      assert.throws(() => estimateFilm([{ implant: femur, image, pose: truth }]), sentence);
    }
    femur.close();
    femur.close();
    for (const call of [() => femur.pose(outline), () => femur.preview(outline), () => femur.profiles(Uint8Array.from(random), truth)]) {
      assert.throws(call, /This implant was closed .* open it again/);
    }
  });

  await t.test('a library is taken as a model is, and one that is refused is let go of', () => librariesTaken(folder));

  await t.test('its types are those of its three lines', () => typesAreRight(folder));
});

/** The example with the module installed beside it, and the demonstration's files. */
async function exampleFolder() {
  const folder = await temporaryFolder();
  await cp(EXAMPLE, folder, { recursive: true });
  await mkdir(join(folder, 'node_modules'), { recursive: true });
  await symlink(join(setting('FLUOROPOSE_PACKAGE'), 'npm'), join(folder, 'node_modules/fluoropose'), 'junction');
  for (const name of ['femur.stl', 'calibration.txt']) await writeFile(join(folder, name), (await demoFile(name)).buffer);
  return folder;
}

/** @param {string} folder */
async function librariesTaken(folder) {
  const from = (/** @type {string} */ name) => import(pathToFileURL(join(folder, 'node_modules/fluoropose', name)).href);
  const { openImplant } = await from('node.js');
  const { frame, outline } = JSON.parse(await readFile(join(folder, 'outline.json'), 'utf8'));
  const [model, calibration] = [await readFile(join(folder, 'femur.stl')), await readFile(join(folder, 'calibration.txt'), 'utf8')];
  const opened = (/** @type {object} */ options) => openImplant({ model, calibration, frame, ...options });
  const femur = await opened({});
  const { library } = femur;
  const again = await opened({ library: library.slice().buffer });
  assert.deepEqual(again.library, library);
  // A last point that repeats the first closes the outline.
  assert.deepEqual(again.preview([...outline, outline[0]]).pose, femur.preview(outline).pose);
  for (const implant of [femur, again]) implant.close();
  await assert.rejects(opened({ library, views: { nominal: [0, 0] } }), /views says what to render, and a library is rendered/);
  const steps = /The library's x rotations from -80 to 80 degrees are more than 4096 steps of 0\.001; give a larger step or a narrower range/;
  await assert.rejects(opened({ views: { x: [-80, 80, 0.001] } }), steps);

  const { memory } = await (await from('pkg/core/fluoropose_wasm.js')).default();
  const tibia = (await demoFile('tibia.stl')).buffer;
  const held = async (/** @type {number} */ times) => {
    for (let time = 0; time < times; time++) await assert.rejects(opened({ model: tibia, library }), /made from another model/);
    return memory.buffer.byteLength;
  };
  const first = await held(1);
  assert.equal(await held(20), first, 'refused libraries stay in memory');
}

/** A binary STL file, its lengths divided by ten. @param {Buffer} model */
function inCentimetres(model) {
  const [smaller, head, triangle] = [Buffer.from(model), 84, 50];
  for (let start = head; start < smaller.length; start += triangle) {
    for (let at = start; at < start + 48; at += 4) smaller.writeFloatLE(smaller.readFloatLE(at) / 10, at);
  }
  return smaller;
}

/** The compiler accepts a right use and refuses a wrong one. @param {string} folder */
async function typesAreRight(folder) {
  const compiler = join(dirname(createRequire(new URL('../../web/package.json', import.meta.url)).resolve('typescript/package.json')), 'bin/tsc');
  const options = ['--noEmit', '--strict', '--skipLibCheck', '--module', 'nodenext', '--target', 'es2022', '--lib', 'es2022,dom'];
  const program = (/** @type {string} */ outline) => `
    import { openImplant, type Pose } from 'fluoropose';
    const implant = await openImplant({ model: new Uint8Array(), calibration: '', frame: { width: 1, height: 1 } });
    export const pose: Pose = implant.pose(${outline}).pose;
  `;
  await writeFile(join(folder, 'right.mts'), program('[[1, 2], [3, 4], [5, 6]]'));
  await run(process.execPath, [compiler, ...options, 'right.mts'], { cwd: folder });
  await writeFile(join(folder, 'wrong.mts'), program("['1, 2']"));
  await assert.rejects(run(process.execPath, [compiler, ...options, 'wrong.mts'], { cwd: folder }), /wrong\.mts|TS2322|TS2345/);
}
