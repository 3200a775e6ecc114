/** Bad input: a sentence in the bottom line, and the work that was there is still there. */
import assert from 'node:assert/strict';
import { pageTest, screenshot, step, until } from './support/browser.mjs';
import { choose, drop, file } from './support/files.mjs';
import { dicom, jpeg, png, tiff } from './support/frames.mjs';
import { femurLibrary } from './support/library.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { demoFile, framePath, trueOutline, truePose } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./support/files.mjs').FileToOpen} FileToOpen */
/** @typedef {import('./support/study.mjs').Point} Point */

/** Fractions of a file that are left of it. */
const CUTS = [0.12, 0.5, 0.9];
const QUANTITIES = /** @type {const} */ (['x', 'y', 'z', 'zRot', 'xRot', 'yRot']);
/** A library begins with eight letters. */
const MAGIC_BITS = 64;
/** What no sentence for a person has in it. */
const GIBBERISH = /undefined|\[object|panick|unreachable|RuntimeError|TypeError|Error:/;
/** An outline that crosses itself, on the frame that has none. */
const BOW_TIE = /** @type {Point[]} */ ([[400, 400], [600, 600], [600, 400], [400, 700]]);

pageTest('bad input', async (page, t) => {
  const stage = new Stage(page);
  const work = await begunWork(page, stage);

  for (const { bad, words } of await badFiles(page)) {
    await step(page, t, bad.name, async (t) => {
      await choose(page, bad);
      t.diagnostic(await refused(page, bad.name, words));
      await stillThere(page, stage, work);
    });
  }

  await step(page, t, 'a bad file among good ones', async () => {
    await drop(page, file('notes.docx', 'PK\u0003\u0004 nothing of ours'), { ...(await demoFile(framePath(3))), name: 'good.png' });
    await panel.waitForFrames(page, 3);
    await panel.waitForWords(page, /not recognised .*: notes\.docx/);
    await screenshot(page, 'error');
    await page.getByRole('button', { name: 'Frame 1, femur: posed' }).click();
    await stillThere(page, stage, work);
  });

  await step(page, t, 'two bad files: both are named', async () => {
    await drop(page, file('notes.docx', 'PK\u0003\u0004 nothing of ours'), { ...png(8), name: 'cut.png', buffer: png(8).buffer.subarray(0, 40) }, { ...png(16), name: 'torn.png', buffer: png(16).buffer.subarray(0, 40) });
    await panel.waitForWords(page, /cut\.png: .*torn\.png: /);
    await stillThere(page, stage, work);
  });

  await step(page, t, 'a frame of another size, and a calibration in pixels a mm', async () => {
    await choose(page, { ...png(8), name: 'small.png' });
    await panel.waitForWords(page, /^small\.png is 24 x 16 pixels but 0001\.png is 1024 x 1024 pixels: a film has frames of one size/);
    await page.keyboard.press('Control+z');
    await panel.waitForFrames(page, 3);
    const calibration = await demoFile('calibration.txt');
    const text = calibration.buffer.toString().replace('0.373', String(1 / 0.373));
    await choose(page, file('wrong.txt', text));
    await panel.waitForWords(page, /^Camera: the focal length, 447\.6 pixels, is 0\.44 times the frame's longer side/);
    await page.getByRole('button', { name: 'Calibration: wrong.txt' }).click();
    await page.getByRole('dialog', { name: 'Calibration' }).getByText(/^Camera: the focal length, 447\.6 pixels/).waitFor();
    await page.keyboard.press('Escape');
    await page.keyboard.press('Control+z');
    await page.getByRole('button', { name: 'Frame 1, femur: posed' }).click();
    await stillThere(page, stage, work);
  });

  await step(page, t, 'an outline that crosses itself', async (t) => {
    await page.getByRole('button', { name: 'Frame 2, femur: empty' }).click();
    await stage.learn();
    await stage.trace(BOW_TIE);
    t.diagnostic(await panel.waitForWords(page, /cross/));
    await until(() => panel.shownPose(page), (pose) => pose === null, 'no pose to be shown');
    await screenshot(page, 'crossing');
    await page.getByRole('button', { name: 'Frame 1, femur: posed' }).click();
    await stillThere(page, stage, work);
  });

  await step(page, t, 'a library with one bit flipped', async (t) => {
    for (const [bit, bad] of flipped(await femurLibrary({ step: 10 }))) {
      await choose(page, bad);
      t.diagnostic(await refused(page, bad.name, bit < MAGIC_BITS ? /not recognised/ : /damaged/));
      await stillThere(page, stage, work);
    }
  });

  await step(page, t, 'another study, dropped on this one, is one of its own', async () => {
    await drop(page, { ...png(8), name: 'other.png' }, await demoFile('calibration.txt'), await demoFile('femur.stl'));
    await panel.waitForFrames(page, 1);
    await panel.waitForWords(page, /It is a study of its own: .* is under Save, Earlier work/);
    await screenshot(page, 'another_study');
    await page.getByRole('button', { name: /^Back to / }).click();
    await page.getByRole('button', { name: 'Frame 1, femur: posed' }).click();
    await panel.waitForThePose(page, work.pose);
  });
});

/** Poses belong to their frames, whatever becomes of those: a row moved by one is a wrong pose that nobody sees. */
pageTest('rows of poses beside a damaged frame', async (page, t) => {
  const frames = await Promise.all([1, 2, 3, 4].map((frame) => demoFile(framePath(frame))));
  const cut = { ...frames[1], buffer: frames[1].buffer.subarray(0, frames[1].buffer.length * 0.66) };
  const films = [frames[0], cut, frames[2], frames[3]];
  const poses = await demoFile('femur.jts');
  const lines = poses.buffer.toString().split(/\r?\n/);
  const rows = (/** @type {number} */ count) => file('femur.jts', `${lines.slice(0, 2 + count).join('\n')}\n`);

  await step(page, t, 'other counts are refused, with both and what could not be read', async () => {
    await choose(page, ...films, rows(6));
    await panel.waitForFrames(page, 3);
    const sentence = await refused(page, 'femur.jts', /6 rows of poses for 3 frames/);
    assert.match(sentence, /0002\.png could not be read/);
    // What other news displaces stays beside the count of frames.
    await page.getByRole('img', { name: /^0002\.png could not be read: frames are counted, and rows written, without it/ }).waitFor();
    assert.deepEqual((await panel.cells(page)).filter((name) => name.includes('pose')), []);
  });
  await step(page, t, 'rows for the damaged one too stay each with its own frame, also after a reload', async () => {
    await panel.waitUntilKept(page);
    await page.reload();
    await panel.waitForFrames(page, 3);
    await choose(page, rows(4));
    await panel.waitForWords(page, /^Opened femur\.jts as poses of the femur \(it has rows for 0002\.png too/);
    await page.getByRole('button', { name: /^Frame 3, femur: pose loaded/ }).click();
    await isNear(page, await truePose('femur', 4));
  });
  await step(page, t, 'the same file mended has its place among them', async () => {
    await choose(page, frames[1]);
    await panel.waitForFrames(page, 4);
    await until(() => panel.cells(page), (cells) => cells.includes('Frame 2, femur: empty') && cells.includes('Frame 4, femur: pose loaded'), 'the mended frame as the second');
    await choose(page, rows(4));
    await page.getByRole('button', { name: /^Frame 2, femur: pose loaded/ }).click();
    await isNear(page, await truePose('femur', 2));
  });
});

/** The pose that is shown, to what the page rounds to. @param {Page} page @param {import('./support/study.mjs').Pose} wanted */
async function isNear(page, wanted) {
  const isIt = (/** @type {import('./support/study.mjs').Pose | null} */ pose) => pose !== null && QUANTITIES.every((name) => Math.abs(pose[name] - wanted[name]) <= panel.ROUNDING[name]);
  await until(() => panel.shownPose(page), isIt, `the pose ${JSON.stringify(wanted)}`);
}

/** An outline with its pose on the first of two frames. @param {Page} page @param {Stage} stage */
async function begunWork(page, stage) {
  const files = [framePath(1), framePath(2), 'calibration.txt', 'femur.stl'];
  await choose(page, ...(await Promise.all(files.map(demoFile))));
  await panel.waitForFrames(page, 2);
  await panel.waitForLibraries(page, 'Femur');
  await stage.learn();
  await stage.trace(await trueOutline('femur', 1));
  const pose = await panel.waitForPose(page);
  return { pose, picture: await stage.picture() };
}

/** @param {Page} page @param {Stage} stage @param {Awaited<ReturnType<typeof begunWork>>} work */
async function stillThere(page, stage, work) {
  await until(() => panel.cells(page), (cells) => cells.includes('Frame 1, femur: posed'), 'the pose to be there');
  await panel.waitForThePose(page, work.pose);
  await stage.looksLike(work.picture, 'the traced frame');
}

/** The sentence that refuses a file. @param {Page} page @param {string} name @param {RegExp} words */
async function refused(page, name, words) {
  const sentence = await panel.waitForWords(page, new RegExp(`(^| )${name}: `));
  assert.match(sentence, words);
  assert(sentence.split(' ').length > 6, `a whole sentence: ${sentence}`);
  assert.doesNotMatch(sentence.slice(name.length), GIBBERISH);
  return sentence;
}

/** Files that cannot be used, and a word of what has to be said of each. @param {Page} page */
async function badFiles(page) {
  const model = await demoFile('femur.stl');
  const frames = [await demoFile(framePath(3)), png(16), tiff([(grey) => grey, (grey) => grey]), dicom([(grey) => grey]), await jpeg(page, 99)];
  const cut = [...frames, model].flatMap((whole) => CUTS.map((left) => ({ bad: shortened(whole, left), words: /damaged|incomplete|ends/ })));
  return [
    ...cut,
    { bad: file('nan.txt', 'JT_INTCALIB\nNaN\n0\n0\n0.373\n'), words: /distance/ },
    { bad: file('zero.txt', 'JT_INTCALIB\n0\n0\n0\n0.373\n'), words: /distance/ },
    { bad: file('short.txt', 'JT_INTCALIB\n1200\n0\n'), words: /ends/ },
    { bad: file('femur-nothing.stl', Buffer.alloc(84)), words: /no triangle/ },
    { bad: file('femur-solid.stl', 'solid nothing\nendsolid nothing\n'), words: /no triangle/ },
    { bad: file('study.zip', 'PK\u0003\u0004 a study'), words: /archive.*unpack it/ },
    { bad: file('femur-empty.stl', ''), words: /empty|not recognised/ },
    { bad: file('nan.jts', 'JT_EULER_312\nx_tran, y_tran, z_tran, z_rot, x_rot, y_rot\n1, 2, NaN, 4, 5, 6\n'), words: /Line 3 .* six numbers/ },
    { bad: file('cut.fluoropose.json', '{"kind":"fluoropose-session","version":1,"docu'), words: /cut short|damaged/ },
  ];
}

/** @param {FileToOpen} whole @param {number} left fraction */
function shortened({ name, buffer }, left) {
  return file(`cut-${Math.round(100 * left)}-${name}`, buffer.subarray(0, Math.floor(left * buffer.length)));
}

/** The same library, wrong in one bit: of its first bytes, its header, its views and its end. @param {Uint8Array} library */
function flipped(library) {
  const last = 8 * library.length - 1;
  return [3, 8 * 20 + 6, 8 * 200, Math.floor(last / 2), last].map((bit) => {
    const bytes = Uint8Array.from(library);
    bytes[bit >> 3] ^= 1 << (bit & 7);
    return /** @type {const} */ ([bit, file(`bit-${bit}.lib`, bytes)]);
  });
}

/** By the rule of the commands: one that the decoders' worker has. */
pageTest('a gap among numbered frames is told', async (page) => {
  const frame = await demoFile(framePath(1));
  await choose(page, ...[1, 2, 3, 5, 6].map((number) => file(`k_${number}.png`, frame.buffer)));
  await panel.waitForWords(page, /1 of the numbered files is missing, between k_3\.png and k_5\.png: the frames at hand/);
});
