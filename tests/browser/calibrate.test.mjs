/** Calibration from a bead grid and from a ruler, and correction of distortion, by role and name. */
import assert from 'node:assert/strict';
import { drawn, pageTest, says, screenshot, step, until } from './support/browser.mjs';
import { choose, downloaded } from './support/files.mjs';
import * as panel from './support/panel.mjs';
import { distorted, ideal, plate, PLATE, tilted } from './support/plates.mjs';
import { Stage } from './support/stage.mjs';

/** @typedef {import('playwright-core').Page} Page */

/** @param {Page} page */
const sheetOf = (page) => page.getByRole('dialog', { name: 'Calibrate from a grid or ruler' });

/** @param {Page} page */
async function openSheet(page) {
  await page.getByRole('button', { name: /^Calibration:/ }).click();
  await page.getByRole('button', { name: 'Calibrate from a grid or ruler' }).click();
  return sheetOf(page);
}

/** @param {import('playwright-core').Locator} sheet @param {Record<string, number>} values */
async function fill(sheet, values) {
  for (const [name, value] of Object.entries(values)) await sheet.getByRole('spinbutton', { name }).fill(String(value));
}

/** The pixel pitch that the sheet shows. @param {import('playwright-core').Locator} sheet */
async function pitch(sheet) {
  await drawn(sheet.page());
  const text = await says(sheet.getByRole('group', { name: 'Camera' }), /Pixel pitch [\d.]+/);
  return Number(/Pixel pitch ([\d.]+)/.exec(text)?.[1]);
}

const LENGTHS = { 'Source to detector (mm)': 1200, 'Source to plate (mm)': 1000, 'Bead spacing (mm)': 10 };
/** 10 mm at 1000 of 1200 mm are 12 mm at the detector. */
const TRUE_PITCH = 12 / PLATE.spacing;
/** A bead near a corner, where the picture is distorted by ten pixels against the regular lattice that lies nearest. */
const OUTER = /** @type {const} */ ([9, -8]);

pageTest('a distorted plate: beads, correction, camera', async (page, t) => {
  const stage = new Stage(page);
  const said = (/** @type {RegExp} */ words) => says(sheetOf(page), words);

  await step(page, t, 'the beads are found and the distortion is told', async (t) => {
    await choose(page, plate('plate.png'));
    await panel.waitForFrames(page, 1);
    // Before the sheet lies over a corner of the canvas.
    await stage.learn();
    const sheet = await openSheet(page);
    await sheet.getByRole('button', { name: 'Find the beads' }).click();
    const text = await said(/px after a correction of order \d/);
    const [, before, after] = /lie ([\d.]+) px \(RMS\) off a regular lattice, and ([\d.]+) px after/.exec(text) ?? [];
    t.diagnostic(`${before} px before, ${after} px after`);
    assert(Number(before) > 1 && Number(after) < 0.05, `${before} px before, ${after} px after`);
    await sheet.getByRole('img', { name: /Residuals of the beads/ }).waitFor();
    await screenshot(page, 'calibrate beads');
  });

  await step(page, t, 'undistorted frames show beads where a regular lattice has them', async () => {
    await until(() => stage.greyAt(distorted(ideal(...OUTER))), (grey) => grey < 100, 'a bead to be dark where it was taken');
    await sheetOf(page).getByRole('button', { name: 'Undistort the frames' }).click();
    await said(/In use on frames/);
    await until(() => stage.greyAt(distorted(ideal(...OUTER))), (grey) => grey > 100, 'the bead to leave its distorted place');
    await screenshot(page, 'calibrate undistorted');
  });

  await step(page, t, 'the camera of the undistorted plate', async (t) => {
    const sheet = sheetOf(page);
    await fill(sheet, LENGTHS);
    const found = await pitch(sheet);
    t.diagnostic(`pixel pitch ${found} mm`);
    // The undistorted picture is as large as the distorted one on the whole, so a little larger than the ideal one.
    assert(Math.abs(found / TRUE_PITCH - 1) < 0.05, `${found} for about ${TRUE_PITCH}`);
    await says(sheet.getByRole('group', { name: 'Camera' }), /A plate this level .* does not show it/);
    await sheet.getByRole('button', { name: 'Use as calibration' }).click();
    await page.getByRole('button', { name: 'Calibration: grid in plate.png' }).waitFor();
  });

  await step(page, t, 'the correction is saved, taken away, undone and opened again', async () => {
    const sheet = sheetOf(page);
    const saved = await downloaded(page, 'Save the correction (.json)');
    assert.equal(JSON.parse(saved.buffer.toString()).kind, 'fluoropose-distortion');
    await sheet.getByRole('button', { name: 'Take the correction away' }).click();
    await until(() => stage.greyAt(distorted(ideal(...OUTER))), (grey) => grey < 100, 'the bead to be back');
    await page.getByRole('button', { name: 'Undo: take the correction of distortion away' }).click();
    await said(/In use on frames/);
    await page.getByRole('button', { name: /^Undo: change the calibration/ }).click();
    await page.getByRole('button', { name: /^Undo: correct the distortion/ }).click();
    await until(() => stage.greyAt(distorted(ideal(...OUTER))), (grey) => grey < 100, 'the bead to be back');
    await choose(page, saved);
    await panel.waitForWords(page, /Opened the correction of distortion|shown undistorted/);
    await said(/In use on frames/);
  });

  await step(page, t, 'outlines alone may be undistorted: frames stay as they were taken', async () => {
    const sheet = sheetOf(page);
    await sheet.getByRole('button', { name: 'Undistort outlines only' }).click();
    await said(/In use on outlines/);
    await until(() => stage.greyAt(distorted(ideal(...OUTER))), (grey) => grey < 100, 'the frame to be as it was taken');
  });
});

pageTest('a tilted plate is told from a distorted picture', async (page, t) => {
  await step(page, t, 'its camera is right as it was taken, and said to be off once a correction has taken the tilt', async (t) => {
    await choose(page, plate('tilted.png', tilted));
    await panel.waitForFrames(page, 1);
    const sheet = await openSheet(page);
    const camera = sheet.getByRole('group', { name: 'Camera' });
    await sheet.getByRole('button', { name: 'Find the beads' }).click();
    await says(sheet, /px after a correction of order \d/);
    await fill(sheet, LENGTHS);
    const asTaken = await pitch(sheet);
    assert(Math.abs(asTaken / TRUE_PITCH - 1) < 0.003, `${asTaken} for ${TRUE_PITCH}`);
    assert.doesNotMatch(await camera.innerText(), /takes for distortion/);
    await sheet.getByRole('button', { name: 'Undistort the frames' }).click();
    await says(sheet, /In use on frames/);
    await says(camera, /As it was taken the plate is tilted by 12°, which the correction takes for distortion/);
    const straightened = await pitch(sheet);
    t.diagnostic(`pixel pitch ${asTaken} mm, ${straightened} mm straightened, ${TRUE_PITCH} mm in truth`);
    assert(Math.abs(straightened / TRUE_PITCH - 1) > 0.005, `${straightened} would be right`);
    await screenshot(page, 'calibrate tilted');
  });
});

pageTest('a frame without a grid says so', async (page, t) => {
  await step(page, t, 'and looking for one can be called off or fails in a sentence', async () => {
    await choose(page, plate('none.png', () => [-100, -100]));
    await panel.waitForFrames(page, 1);
    const sheet = await openSheet(page);
    await sheet.getByRole('button', { name: 'Find the beads' }).click();
    await panel.waitForWords(page, /none\.png: 0 beads in a square lattice were found and at least 20 are needed/);
  });
});

pageTest('a ruler: two marks and their length', async (page, t) => {
  const stage = new Stage(page);
  const lengths = { 'Source to detector (mm)': 1200, 'Source to ruler (mm)': 1000, 'Length between the marks (mm)': 100 };

  await step(page, t, 'marks by mouse', async (t) => {
    await choose(page, plate('ruler.png', (place) => place));
    await panel.waitForFrames(page, 1);
    const sheet = await openSheet(page);
    await sheet.getByRole('radio', { name: 'Ruler' }).click();
    await stage.learn();
    // Ten beads apart along a row: 100 mm.
    await stage.click(ideal(-8, 0));
    await stage.click(ideal(2, 0));
    await fill(sheet, lengths);
    const found = await pitch(sheet);
    t.diagnostic(`pixel pitch ${found} mm for ${TRUE_PITCH}`);
    assert(Math.abs(found / TRUE_PITCH - 1) < 0.01, `${found} for ${TRUE_PITCH}`);
    await screenshot(page, 'calibrate ruler');
  });

  await step(page, t, 'marks by keyboard alone, exactly', async () => {
    const sheet = sheetOf(page);
    const [a, b] = [ideal(-8, 0), ideal(2, 0)];
    await fill(sheet, { 'Mark 1 column (px)': a[0], 'Mark 1 row (px)': a[1], 'Mark 2 column (px)': b[0], 'Mark 2 row (px)': b[1] });
    const exact = Number(TRUE_PITCH.toFixed(5));
    await until(() => pitch(sheet), (now) => now === exact, `the pitch ${exact}`);
  });

  await step(page, t, 'lengths that cannot be are refused in words', async () => {
    const sheet = sheetOf(page);
    await fill(sheet, { 'Source to ruler (mm)': 1300 });
    await says(sheet.getByRole('alert'), /the object must lie between them/);
    await fill(sheet, { 'Source to ruler (mm)': 1000 });
    await sheet.getByRole('button', { name: 'Use as calibration' }).click();
    await page.getByRole('button', { name: 'Calibration: ruler in ruler.png' }).waitFor();
  });
});
