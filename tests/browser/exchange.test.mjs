/** Outlines and masks of other programs: recognised, shown before they are taken in, and written again. */
import assert from 'node:assert/strict';
import { isDeepStrictEqual } from 'node:util';
import { atRest, pageTest, screenshot, step, until, visit } from './support/browser.mjs';
import { exported } from './support/exporting.mjs';
import { choose, drop, file } from './support/files.mjs';
import { differing, drawnMask, dropFolder, dropMasks, importAll, maskFile, maskOf, proposed, unzipped } from './support/masks.mjs';
import * as panel from './support/panel.mjs';
import { demoFile, framePath, truePose } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./support/files.mjs').FileToOpen} FileToOpen */
/** @typedef {import('./support/masks.mjs').Mask} Mask */

const FRAMES = 3;
/** What the true mask gives, a little over the worst of these frames when simplified to 0.4 px. */
const FROM_MASK = { x: 0.2, y: 0.2, z: 3, zRot: 0.3, xRot: 0.4, yRot: 0.4 };
const SIDE = 1024;

pageTest('masks give poses', async (page, t) => {
  await openFrames(page, 'femur.stl');
  await panel.waitForLibraries(page, 'Femur');

  await step(page, t, 'a folder of masks is recognised and shown before anything changes', async () => {
    await dropMasks(page, ['femur', 'tibia'], [1, 2, 3]);
    const wanted = [
      'masks/femur/0001.png -> frame 1 (0001.png), femur',
      'masks/femur/0002.png -> frame 2 (0002.png), femur',
      'masks/femur/0003.png -> frame 3 (0003.png), femur',
      'masks/tibia/0001.png -> frame 1 (0001.png), tibia',
      'masks/tibia/0002.png -> frame 2 (0002.png), tibia',
      'masks/tibia/0003.png -> frame 3 (0003.png), tibia',
    ];
    await until(() => proposed(page), (rows) => isDeepStrictEqual(rows.map(({ from, to }) => `${from} -> ${to}`), wanted), wanted.join('; '));
    await screenshot(page, 'import');
    assert.deepEqual(new Set((await panel.cells(page)).map((name) => name.split(': ')[1])), new Set(['empty']));
    await importAll(page, 6);
  });

  await step(page, t, 'the poses are those of the masks, and one undo takes all of it back', async () => {
    for (const frame of [1, 2]) {
      await page.getByRole('button', { name: `Frame ${frame}, femur` }).click();
      // The panel may show the frame before for a moment.
      await atRest(page);
      panel.assertNear(await panel.waitForPose(page), await truePose('femur', frame), FROM_MASK);
    }
    await page.keyboard.press('Control+z');
    await until(() => panel.cells(page), (cells) => cells.every((name) => name.endsWith(': empty')), 'every cell to be empty');
    await page.keyboard.press('Control+y');
    await until(() => panel.cells(page), (cells) => cells.filter((name) => name.endsWith(': posed')).length === 3, 'three femoral poses');
  });
});

pageTest('masks of other frames are told as such', async (page) => {
  const count = 4;
  await panel.openDemonstration(page, count);
  await panel.waitForLibraries(page, 'Femur', 'Tibia');
  const names = Array.from({ length: count }, (_, at) => `000${at + 1}.png`);
  const masks = await Promise.all(names.map(async (name, at) => /** @type {const} */ ([name, (await maskFile('femur', at + 5)).buffer])));
  await dropFolder(page, 'femur', masks);
  await importAll(page, count);
  await panel.waitForWords(page, /^4 of 4 masks of the femur do not lie on the edges of their frames: they may be of other frames\./);
  await page.getByRole('button', { name: 'Doubtful: look at it' }).click();
  await page.getByRole('region', { name: 'A doubtful pose' }).getByText('4 of 4 masks of the femur').waitFor();
});

pageTest('outlines and masks come and go', async (page, t) => {
  /** @type {Record<string, FileToOpen>} */
  const saved = {};
  await openFrames(page);

  await step(page, t, 'exactly imported masks leave as they came', async () => {
    await dropMasks(page, ['femur', 'tibia'], [1, 3]);
    await page.getByRole('checkbox', { name: /^Exactly along the pixels/ }).check();
    await importAll(page, 4);
    for (const name of ['Our JSON', 'COCO polygons', 'Masks']) saved[name] = await exported(page, 'Outlines', name);
    const files = unzipped(saved.Masks);
    const paths = ['femur/0001.png', 'femur/0003.png', 'tibia/0001.png', 'tibia/0003.png'];
    assert.deepEqual(Object.keys(files).filter((path) => path.endsWith('.png')).sort(), paths);
    for (const path of paths) {
      const [component, name] = path.split('/');
      const came = await maskFile(/** @type {'femur'} */ (component), parseInt(name, 10));
      assert.equal(differing(maskOf(files[path]), maskOf(came.buffer)), 0, `${path} differs from the mask that was imported`);
    }
  });

  for (const name of ['Our JSON', 'COCO polygons']) {
    await step(page, t, `${name} come back into a fresh page as they left`, async () => {
      await visit(page);
      await openFrames(page);
      await drop(page, saved[name]);
      await until(() => proposed(page), (rows) => rows.length === 4, 'four outlines');
      await importAll(page, 4);
      const again = await exported(page, 'Outlines', name);
      assert.deepEqual(JSON.parse(again.buffer.toString()), JSON.parse(saved[name].buffer.toString()));
    });
  }
});

pageTest('outlines of other programs', async (page, t) => {
  await openFrames(page, 'femur.stl');
  const tray = maskOf((await maskFile('tibia', 1)).buffer);

  await step(page, t, 'an array of masks, run lengths and polygons are shown with their frames', async () => {
    const femurs = await Promise.all([1, 2, 3].map(async (frame) => maskOf((await maskFile('femur', frame)).buffer)));
    const polygon = { label: 'tibia', shape_type: 'polygon', points: [[100, 100], [300, 100.5], [300, 300]] };
    const labelme = { version: '5.4.1', flags: {}, shapes: [polygon], imagePath: '../x/0002.png', imageWidth: SIDE, imageHeight: SIDE };
    await drop(page, file('femur.npy', arrayOf(femurs)), file('runs.json', runsOf('0001.png', 'tibia', tray)), file('0002.json', JSON.stringify(labelme)));
    const wanted = ['femur.npy #1 1 femur', 'femur.npy #2 2 femur', 'femur.npy #3 3 femur', '0001.png, tibia (annotation 1) 1 tibia', '0002.png, tibia 2 tibia'];
    const shown = async () => (await proposed(page)).map(({ from, to }) => `${from} ${to.replace(/^frame (\d).*, /, '$1 ')}`);
    await until(shown, (rows) => isDeepStrictEqual(rows.toSorted(), wanted.toSorted()), wanted.join('; '));
    await screenshot(page, 'import of others');
  });

  await step(page, t, 'poses are those of the masks, and masks leave as they came', async () => {
    await page.getByRole('checkbox', { name: /^Exactly along the pixels/ }).check();
    await importAll(page, 5);
    await panel.waitForLibraries(page, 'Femur');
    await page.getByRole('button', { name: 'Frame 2, femur' }).click();
    await atRest(page);
    panel.assertNear(await panel.waitForPose(page), await truePose('femur', 2), FROM_MASK);
    const files = unzipped(await exported(page, 'Outlines', 'Masks'));
    assert.equal(differing(maskOf(files['tibia/0001.png']), tray), 0);
  });
});

pageTest('blank frames stay in the film', async (page) => {
  const blank = (/** @type {string} */ name, /** @type {number} */ grey) => drawnMask(name, SIDE, SIDE, () => grey);
  await drop(page, await demoFile(framePath(1)), blank('0002.png', 0), blank('0003.png', 255), await demoFile(framePath(4)));
  await panel.waitForFrames(page, 4);
});

pageTest('what does not fit is said', async (page, t) => {
  await openFrames(page);

  await step(page, t, 'specks, holes, sizes and empty masks', async () => {
    const blob = (/** @type {number} */ column, /** @type {number} */ row) => {
      const hole = Math.hypot(column - 400, row - 400) < 20;
      const speck = column >= 900 && column < 910 && row >= 900 && row < 904;
      return (Math.hypot(column - 400, row - 400) < 200 && !hole) || speck ? 255 : 0;
    };
    await dropFolder(page, 'femur', [
      ['0001.png', drawnMask('a', SIDE, SIDE, blob).buffer],
      ['0002.png', drawnMask('b', 512, 512, (column) => (column > 100 && column < 300 ? 1 : 0)).buffer],
      ['0003.png', drawnMask('c', SIDE, SIDE, () => 0).buffer],
      ['0009.png', drawnMask('d', SIDE, SIDE, (column, row) => (column < 90 && row < 90 ? 1 : 0)).buffer],
    ]);
    const [first, second, third] = await until(() => proposed(page), (rows) => rows.length === 3, 'three masks');
    assert.match(first.notes, /specks of 40 px left out; holes of 12\d\d px filled/);
    assert.match(first.to, /^frame 1/);
    assert.equal(second.to, 'left out: its image has 512 x 512 px, frame 2 has 1024 x 1024');
    assert.equal(third.to, 'left out: no frame is called 0009.png');
    await page.getByRole('list', { name: 'What could not be read' }).getByText('femur/0003.png is empty').waitFor();
    await screenshot(page, 'import troubles');
    await page.getByRole('dialog', { name: 'Import outlines' }).getByRole('button', { name: 'Cancel' }).click();
    assert((await panel.cells(page)).every((name) => name.endsWith(': empty')));
  });

  await step(page, t, 'a picture among masks is no frame of the film, and masks by order of another number than frames are told', async () => {
    const disc = drawnMask('a', SIDE, SIDE, (column, row) => (Math.hypot(column - 400, row - 400) < 200 ? 255 : 0)).buffer;
    const noise = drawnMask('b', SIDE, SIDE, (column, row) => (column * 7919 + row * 104729 + ((column * row) % 251)) % 256).buffer;
    const masks = ['a', 'b', 'c', 'd', 'e'].map((name) => /** @type {const} */ ([`${name}.png`, disc]));
    await dropFolder(page, 'femur', [...masks, ['f.png', noise]]);
    await until(() => proposed(page), (rows) => rows.length === 5, 'five masks');
    const sheet = page.getByRole('dialog', { name: 'Import outlines' });
    await page.getByRole('list', { name: 'What could not be read' }).getByText(/^femur\/f\.png: .*it is no mask/).waitFor();
    await page.getByRole('radio', { name: 'order' }).check();
    await sheet.getByText(`femur: 6 images for ${FRAMES} frames.`).waitFor();
    await sheet.getByRole('button', { name: 'Cancel' }).click();
    await panel.waitForFrames(page, FRAMES);
  });

  await step(page, t, 'grey values and categories that nobody knows are asked for', async () => {
    const two = drawnMask('labels2.png', SIDE, SIDE, (column, row) => (row < 100 || row > 900 ? 0 : column < 400 ? 1 : column < 600 ? 0 : 2));
    await choose(page, two);
    await until(() => proposed(page), (rows) => rows.every(({ to }) => to.endsWith('is left out')), 'both to be left out');
    const sheet = page.getByRole('dialog', { name: 'Import outlines' });
    await sheet.getByRole('combobox', { name: 'Component of grey value 1' }).selectOption('Tibia');
    await sheet.getByRole('combobox', { name: 'Component of grey value 2' }).selectOption('Femur');
    await until(() => proposed(page), (rows) => rows.every(({ to }) => to.startsWith('frame 2')), 'both to go to frame 2');
    await importAll(page, 2);
    const traced = (/** @type {string[]} */ cells) => ['Frame 2, femur', 'Frame 2, tibia'].every((place) => cells.some((name) => name.startsWith(place) && !name.endsWith('empty')));
    await until(() => panel.cells(page), traced, 'both outlines on frame 2');
  });

  await step(page, t, 'a TIFF mask and COCO polygons by order', async () => {
    await drop(page, tiffMask('seg_a.tif'), file('labels.json', coco()));
    await until(() => proposed(page), (rows) => rows.length === 3, 'three outlines');
    await page.getByRole('radio', { name: 'order' }).check();
    const sheet = page.getByRole('dialog', { name: 'Import outlines' });
    await sheet.getByRole('combobox', { name: 'Component of masks without a name' }).selectOption('Tibia');
    await sheet.getByRole('combobox', { name: 'Component of Shield' }).selectOption('Femur');
    const wanted = ['frame 1 (0001.png), femur', 'frame 3 (0003.png), femur', 'frame 1 (0001.png), tibia'];
    await until(() => proposed(page), (now) => now.map(({ to }) => to).join('; ') === wanted.join('; '), wanted.join('; '));
    await importAll(page, 3);
  });

  await step(page, t, 'bad files are named, and the work is still there', async () => {
    const before = await panel.cells(page);
    await choose(page, file('cut.outlines.json', '{"kind":"fluoropose-outlines","version":1,"fra'));
    await panel.waitForWords(page, /^cut\.outlines\.json: it is cut short or damaged/);
    await choose(page, file('none.json', '{"images":[],"annotations":[],"categories":[]}'));
    await panel.waitForWords(page, /^none\.json: there are no annotations/);
    await choose(page, file('runs.json', coco({ counts: [4, 5], size: [SIDE, SIDE] })));
    await panel.waitForWords(page, /^runs\.json: annotation \d+ .* has run lengths that do not fill its image/);
    assert.deepEqual(await panel.cells(page), before);
  });

  await step(page, t, 'outlines without frames are told to wait', async () => {
    await visit(page);
    await choose(page, file('labels.json', coco()));
    await panel.waitForWords(page, /^labels\.json: outlines are for frames: open the frames first/);
  });
});

/** @param {Page} page @param {...string} more files of the demonstration */
async function openFrames(page, ...more) {
  const names = ['calibration.txt', ...more, ...Array.from({ length: FRAMES }, (_, index) => framePath(index + 1))];
  await choose(page, ...(await Promise.all(names.map(demoFile))));
  await panel.waitForFrames(page, FRAMES);
}

/** An uncompressed grey TIFF of 8 bits with a square in it, after TIFF 6.0. @param {string} name */
function tiffMask(name) {
  const fields = [[256, 3, SIDE], [257, 3, SIDE], [258, 3, 8], [259, 3, 1], [262, 3, 1], [273, 4, 0], [277, 3, 1], [278, 3, SIDE], [279, 4, SIDE * SIDE]];
  const size = 8 + 2 + 12 * fields.length + 4;
  const bytes = Buffer.alloc(size + SIDE * SIDE);
  bytes.write('II');
  bytes.writeUInt16LE(42, 2);
  bytes.writeUInt32LE(8, 4);
  bytes.writeUInt16LE(fields.length, 8);
  fields.forEach(([tag, type, value], index) => {
    const at = 10 + 12 * index;
    bytes.writeUInt16LE(tag, at);
    bytes.writeUInt16LE(type, at + 2);
    bytes.writeUInt32LE(1, at + 4);
    bytes.writeUInt32LE(tag === 273 ? size : value, at + 8);
  });
  for (let row = 300; row < 500; row++) bytes.fill(1, size + row * SIDE + 300, size + row * SIDE + 500);
  return file(name, bytes);
}

/** Two annotations of one category that no name tells, on the first and the third image. @param {unknown} [segmentation] */
function coco(segmentation = [[100, 100, 300, 100, 300, 300, 100, 300]]) {
  const images = [1, 2, 3].map((id) => ({ id, file_name: `export_${'abc'[id - 1]}.png`, width: SIDE, height: SIDE }));
  const annotations = [1, 3].map((image_id, index) => ({ id: index + 1, image_id, category_id: 5, segmentation }));
  return JSON.stringify({ images, annotations, categories: [{ id: 5, name: 'Shield' }] });
}

/** Masks as NumPy writes an array of truths. @param {readonly Mask[]} masks */
function arrayOf(masks) {
  const header = `{'descr': '|b1', 'fortran_order': False, 'shape': (${masks.length}, ${SIDE}, ${SIDE}), }\n`;
  return Buffer.concat([Buffer.from(`\x93NUMPY\x01\0${String.fromCharCode(header.length)}\0${header}`, 'latin1'), ...masks.map(({ inside }) => Uint8Array.from(inside, Number))]);
}

/** A mask in COCO's run lengths. @param {string} image @param {string} name @param {Mask} mask */
function runsOf(image, name, { inside }) {
  const counts = [0];
  for (let at = 0; at < SIDE * SIDE; at++) {
    const isInside = inside[(at % SIDE) * SIDE + Math.floor(at / SIDE)];
    if (isInside !== (counts.length % 2 === 0)) counts.push(0);
    counts[counts.length - 1]++;
  }
  const annotations = [{ id: 1, image_id: 7, category_id: 2, segmentation: { size: [SIDE, SIDE], counts } }];
  return JSON.stringify({ images: [{ id: 7, file_name: image, width: SIDE, height: SIDE }], annotations, categories: [{ id: 2, name }] });
}
