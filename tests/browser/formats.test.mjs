/** What comes in other ways: folders, videos, compressed DICOM, sizes that a file states, and what cannot be read. */
import assert from 'node:assert/strict';
import { mkdir, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { pageTest, says, screenshot, step, until, visit } from './support/browser.mjs';
import { choose, dropPaths, file, temporaryFolder } from './support/files.mjs';
import { dicomOf, JPEG_2000, png } from './support/frames.mjs';
import * as panel from './support/panel.mjs';
import { Stage } from './support/stage.mjs';
import { demoFile } from './support/study.mjs';
import { webmOf } from './support/video.mjs';

/** @typedef {import('playwright-core').Page} Page */

/** Greys of the pictures of the video, far enough apart to tell them from each other. */
const LEVELS = [20, 60, 100, 140, 180, 220];
const VIDEO = { width: 320, height: 240, milliseconds: 200 };

/** @param {Page} page */
async function recorded(page) {
  return file('run 3.webm', await webmOf(page, { levels: LEVELS, ...VIDEO }));
}

/** @param {Page} page @param {number} frame from 1 */
async function goTo(page, frame) {
  await page.getByRole('slider', { name: 'Frame', exact: true }).fill(String(frame - 1));
  await page.getByRole('application', { name: new RegExp(`frame ${frame} of`) }).waitFor();
}

pageTest('frames of a video', async (page, t) => {
  const stage = new Stage(page);

  await step(page, t, 'are chosen and taken, in order, each once', async (t) => {
    await choose(page, await recorded(page));
    const sheet = page.getByRole('dialog', { name: 'Frames of a video' });
    await says(sheet, /run 3\.webm: 320 x 240 px/);
    await says(sheet, /compressed: edges may have moved/);
    t.diagnostic(await sheet.locator('p').first().innerText());
    await screenshot(page, 'video sheet');
    await sheet.getByRole('button', { name: 'Take these frames' }).click();
    await panel.waitForWords(page, /frames taken from run 3\.webm.*Compression may have moved edges/);
    const greys = [];
    const names = (await panel.cells(page)).filter((name) => name.includes('femur'));
    for (let frame = 1; frame <= names.length; frame++) {
      await goTo(page, frame);
      await stage.learn();
      greys.push(await stage.greyAt([160.5, 120.5]));
    }
    t.diagnostic(`greys ${greys.join(', ')}`);
    const levels = greys.map((grey) => LEVELS.findIndex((level) => Math.abs(level - grey) < 15));
    assert(levels.every((level) => level >= 0), `each grey is one of those recorded: ${greys}`);
    assert.deepEqual(levels, LEVELS.map((_, index) => index), 'every picture once, in their order');
  });

  await step(page, t, 'a stretch of it, and every other frame', async () => {
    await visit(page);
    await choose(page, await recorded(page));
    const sheet = page.getByRole('dialog', { name: 'Frames of a video' });
    await sheet.waitFor();
    await sheet.getByRole('spinbutton', { name: 'From (s)' }).fill('0.9');
    await sheet.getByRole('spinbutton', { name: 'To (s)' }).fill('0.2');
    await says(sheet, /No frame lies in this stretch/);
    await sheet.getByRole('button', { name: 'Take these frames', disabled: true }).waitFor();
    await page.keyboard.press('Escape');
    await sheet.waitFor({ state: 'detached' });
  });

  await step(page, t, 'what the browser cannot decode is said, with the remedy', async () => {
    await choose(page, file('old.avi', Buffer.concat([Buffer.from('RIFF\0\0\0\0AVI LIST'), Buffer.alloc(200)])));
    await panel.waitForWords(page, /old\.avi: this browser cannot decode this video\. Convert it to MP4 .* DICOM, TIFF or PNG/);
  });
});

pageTest('a whole folder with whatever it holds', async (page, t) => {
  await step(page, t, 'is dropped: frames in the order of their numbers, the rest where it belongs', async () => {
    const study = join(await temporaryFolder(), 'study');
    await mkdir(join(study, 'frames'), { recursive: true });
    const frames = ['knee10.png', 'knee9.png', 'knee2.png'];
    const all = [
      ...frames.map((name, index) => [join('frames', name), png(8, (grey) => (grey + index) % 256).buffer]),
      ['calibration.txt', (await demoFile('calibration.txt')).buffer],
      ['femur.stl', Buffer.concat([(await demoFile('femur.stl')).buffer, Buffer.alloc(36)])],
      ['Thumbs.db', Buffer.from('not meant')],
      ['.DS_Store', Buffer.from('not meant')],
      ['notes.docx', Buffer.from('PK once upon a time')],
      ['table.xlsx', Buffer.from('PK once upon a time')],
    ];
    await Promise.all(all.map(([name, content]) => writeFile(join(study, String(name)), content)));
    await dropPaths(page, [study]);
    await panel.waitForFrames(page, 3);
    await page.getByRole('button', { name: 'Calibration: calibration.txt' }).waitFor();
    await page.getByRole('button', { name: /^Femur: femur\.stl/ }).waitFor();
    // Frames of eight pixels are none of that calibration's camera, which is said last.
    await panel.waitForWords(page, /^Camera: the focal length/);
    for (const [index, name] of ['knee2.png', 'knee9.png', 'knee10.png'].entries()) {
      await goTo(page, index + 1);
      await page.getByRole('application', { name: new RegExp(`^${name}, frame`) }).waitFor();
    }
    await page.getByRole('button', { name: 'Log', exact: true }).click();
    const log = page.getByRole('dialog', { name: 'Log' });
    await says(log, /2 files were not recognised and left out: study\/notes\.docx and study\/table\.xlsx/);
    await says(log, /36 bytes after the last of its \d+ triangles were left out/);
  });

  await step(page, t, 'is chosen with the button', async () => {
    await visit(page);
    const folder = join(await temporaryFolder(), 'run');
    await mkdir(folder);
    await Promise.all(['b2.png', 'b10.png'].map((name) => writeFile(join(folder, name), png(8, (grey) => (grey + name.length) % 256).buffer)));
    const chooser = page.waitForEvent('filechooser');
    await page.getByRole('button', { name: 'Open a folder' }).click();
    await (await chooser).setFiles(folder);
    await panel.waitForFrames(page, 2);
    await page.getByRole('application', { name: /^b2\.png, frame 1 of 2/ }).waitFor();
  });
});

pageTest('compressed DICOM', async (page, t) => {
  const stage = new Stage(page);
  await step(page, t, 'JPEG 2000 is read to the last grey value', async () => {
    await choose(page, dicomOf(JPEG_2000.file));
    await panel.waitForFrames(page, 1);
    await stage.learn();
    for (const [column, row] of [[0, 0], [11, 8], [5, 3]]) {
      assert.equal(await stage.greyAt([column + 0.5, row + 0.5]), JPEG_2000.greyAt(column, row));
    }
  });

  await step(page, t, 'a coding that is not read is named, with what to do', async () => {
    await choose(page, dicomOf({ ...JPEG_2000.file, syntax: '1.2.840.10008.1.2.4.110' }));
    await panel.waitForWords(page, /JPEG XL lossless pixels \(transfer syntax 1\.2\.840\.10008\.1\.2\.4\.110\), which is not read\. Export it/);
  });
});

pageTest('sizes that a DICOM file states', async (page, t) => {
  const chip = page.getByRole('button', { name: /^Calibration:/ });
  const sheet = page.getByRole('dialog', { name: 'Calibration', exact: true });
  const field = (/** @type {string} */ name) => sheet.getByRole('spinbutton', { name });

  await step(page, t, 'are offered with their tag and their plane, and not taken', async () => {
    await choose(page, dicomOf({ ...JPEG_2000.file, stated: { '0018,1110': '1198', '0018,1111': '900 ', '0018,1164': '0.37\\0.37', '0028,0030': '0.3\\0.3 ' } }));
    await panel.waitForFrames(page, 1);
    await panel.waitForWords(page, /The file states sizes and distances/);
    await says(chip, /none/);
    await page.getByRole('button', { name: 'Look at them' }).click();
    const stated = sheet.getByRole('region', { name: 'Stated by the file' });
    await says(stated, /Imager Pixel Spacing \(0018,1164\): 0\.37 mm between pixels at the detector/);
    await says(stated, /Pixel Spacing \(0028,0030\): 0\.3 mm\. The file does not say where that holds/);
    await says(stated, /Distance Source to Detector \(0018,1110\): 1198 mm, the principal distance/);
    assert.equal(await field('Pixel pitch (mm)').inputValue(), '');
    await screenshot(page, 'stated sizes');
  });

  await step(page, t, 'are filled in one by one, when asked for', async () => {
    await sheet.getByRole('button', { name: 'Fill in Pixel pitch' }).click();
    await until(() => field('Pixel pitch (mm)').inputValue(), (value) => value === '0.37', 'the pixel pitch to be filled in');
    assert.equal(await field('Principal distance (mm)').inputValue(), '');
    await sheet.getByRole('button', { name: 'Fill in Principal distance' }).click();
    await sheet.getByRole('button', { name: 'Use these numbers' }).click();
    await page.getByRole('button', { name: 'Calibration: typed' }).waitFor();
  });
});
