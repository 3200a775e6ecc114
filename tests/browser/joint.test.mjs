/** How the joint moves: curves with their numbers, what they wait for, and the table, by keys and by names alone. */
import assert from 'node:assert/strict';
import { isDeepStrictEqual } from 'node:util';
import { bringAxe, isAccessible } from './support/axe.mjs';
import { atRest, drawn, pageTest, screenshot, step, until } from './support/browser.mjs';
import { Calls } from './support/calls.mjs';
import { exportSheet, openExport, savedFile } from './support/exporting.mjs';
import { choose, file } from './support/files.mjs';
import { leftKnee } from './support/joint.mjs';
import { unzipped } from './support/masks.mjs';
import * as panel from './support/panel.mjs';
import { demoFile, readJts } from './support/study.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {Record<string, number> | null} Numbers of a frame, by column */

const FRAMES = 8;
/** Its tibia has no pose. */
const GAP = 4;
const SHOWN = /** @type {const} */ ({
  Flexion: 'flexion_deg',
  Abduction: 'abduction_deg',
  'Internal rotation': 'internal_rotation_deg',
  Anterior: 'field_anterior_mm',
  Superior: 'field_superior_mm',
  Medial: 'field_medial_mm',
  'Lift-off': 'lift_off_mm',
});
const BY_GROOD_AND_SUNTAY = /** @type {const} */ ({ 'Anterior drawer': 'gs_anterior_mm', Distraction: 'gs_distraction_mm', 'Lateral shift': 'gs_lateral_mm' });

pageTest('the joint', async (page, t) => {
  const truth = await opened(page);
  await step(page, t, 'its angles in the frame on view stand beside the pose, where both have one', async () => {
    const angles = page.getByLabel('Joint angles in this frame');
    const read = async () => [...(await angles.innerText()).matchAll(/(−?\d+\.\d+)/g)].map(([text]) => Number(text.replace('−', '-')));
    const wanted = ['flexion_deg', 'abduction_deg', 'internal_rotation_deg'].map((name) => /** @type {Record<string, number>} */ (truth[0])[name] ?? NaN);
    const isNear = (/** @type {number[]} */ now) => now.length === 3 && now.every((angle, at) => Math.abs(angle - (wanted[at] ?? NaN)) < 0.011);
    await until(read, isNear, `angles of ${wanted}`);
    const doubt = angles.getByText('The pose of the tibia is doubtful.');
    assert.equal(await doubt.count(), 0);
    // A tibia that is moved off its edges, while the femur is on view.
    await page.getByRole('radio', { name: 'Tibia' }).click();
    await page.getByRole('application', { name: /outline$/ }).focus();
    await page.keyboard.press('a');
    for (let key = 0; key < 4; key++) await page.keyboard.press('ArrowRight');
    await page.getByRole('button', { name: 'Done' }).click();
    await page.getByRole('radio', { name: 'Femur' }).click();
    await doubt.waitFor();
    await page.getByRole('application', { name: /outline$/ }).focus();
    // Arrows that follow one another are one step back, or on a busy machine some.
    await until(async () => {
      await page.keyboard.press('Control+z');
      await drawn(page);
      return doubt.count();
    }, (count) => count === 0, 'the pose of before');
    await until(read, isNear, 'the angles of before');
    await page.getByRole('application', { name: /outline$/ }).focus();
    for (let frame = 1; frame < GAP; frame++) await page.keyboard.press('f');
    await until(() => angles.count(), (count) => count === 0, 'no angles where the tibia has no pose');
    for (let frame = 1; frame < GAP; frame++) await page.keyboard.press('d');
  });
  await step(page, t, 'is opened by a key, and its numbers are those of another program', async () => {
    await page.keyboard.press('Shift+K');
    await joint(page).getByRole('img', { name: /^Lift-off over frame in 7 frames, / }).waitFor();
    await drawn(page);
    await agrees(page, SHOWN, 1, truth);
    for (let frame = 1; frame < FRAMES; frame++) await page.keyboard.press('f');
    await agrees(page, SHOWN, FRAMES, truth);
    await joint(page).getByRole('radio', { name: 'Grood–Suntay' }).press('Enter');
    await agrees(page, BY_GROOD_AND_SUNTAY, FRAMES, truth);
    await screenshot(page, 'joint');
  });
  await step(page, t, 'asks whether it is the other knee where the femur is made for that', async () => {
    const asked = page.getByLabel('Joint angles in this frame').getByText(/^The femoral component's flange is higher at its left half, /);
    const why = joint(page).getByText(/^The femoral component's flange is higher at its left half, .* stated as right: /);
    assert.equal(await asked.count(), 0);
    await page.getByRole('combobox', { name: 'Side of the body' }).selectOption('right');
    await Promise.all([asked.waitFor(), why.waitFor()]);
    await page.getByRole('combobox', { name: 'Side of the body' }).selectOption('left');
    await Promise.all([asked.waitFor({ state: 'detached' }), why.waitFor({ state: 'detached' })]);
  });
  await step(page, t, 'leads to a frame, and has a gap where a pose is missing', () => leads(page, truth));
  await step(page, t, 'goes on with the film that plays', async () => {
    const shownNow = () => page.getByRole('application', { name: /frame \d+ of 8/ }).getAttribute('aria-label');
    const before = await shownNow();
    await page.getByRole('button', { name: 'Play the film' }).click();
    const line = () => joint(page).getByRole('region', { name: 'Tray from above' }).getByRole('img').getAttribute('aria-label');
    const first = await line();
    await until(shownNow, (now) => now !== before, 'another frame');
    await until(line, (now) => now !== first, 'its line on the tray');
    await page.getByRole('button', { name: 'Stop the film' }).click();
    // The frame that was on its way is shown yet.
    await atRest(page);
    const still = await shownNow();
    // Some frames of the film: nothing can be waited for that does not come.
    await page.waitForTimeout(300);
    await atRest(page);
    assert.equal(await shownNow(), still);
  });
  await step(page, t, 'runs over time and flexion, and one curve can be alone', () => overs(page));
  await step(page, t, 'asks for the side', () => asksForSide(page));
  await step(page, t, 'can be used by everybody', async () => {
    await bringAxe(page);
    await isAccessible(page);
    await page.keyboard.press('Shift+L');
    await drawn(page);
    await isAccessible(page);
  });
  await step(page, t, 'says what is wrong with its files before they are saved', () => saved(page, truth));
});

/** The demonstration with its poses but one. @param {Page} page @returns {Promise<Numbers[]>} */
async function opened(page) {
  const [femur, tibia, model] = [await demoFile('femur.jts'), await demoFile('tibia.jts'), await demoFile('femur.stl')];
  const lines = tibia.buffer.toString().trimEnd().split(/\r?\n/);
  lines[1 + GAP] = 'NaN, NaN, NaN, NaN, NaN, NaN';
  const gapped = file('tibia.jts', `${lines.join('\n')}\n`);
  await panel.openDemonstration(page);
  await choose(page, femur, gapped);
  await until(() => panel.cells(page), (cells) => cells.filter((name) => name.endsWith(': pose loaded')).length === 2 * FRAMES - 1, 'the poses');
  const [femurs, tibias] = [readJts(femur.buffer.toString()), readJts(gapped.buffer.toString())];
  return femurs.map((pose, index) => (index === GAP - 1 ? null : leftKnee(pose, tibias[index], model.buffer)));
}

/** @param {Page} page */
function joint(page) {
  return page.getByRole('region', { name: 'Joint', exact: true });
}

/** What stands above a curve. @param {Page} page @param {string} name @param {number} frame from 1 */
async function shown(page, name, frame) {
  const text = await joint(page).getByRole('status', { name: `${name} in frame ${frame}`, exact: true }).innerText();
  return text.split('\n')[0].trim();
}

/** @param {Page} page @param {Record<string, string>} names @param {number} frame from 1 @param {Numbers[]} truth */
async function agrees(page, names, frame, truth) {
  for (const [name, column] of Object.entries(names)) {
    const found = Number((await shown(page, name, frame)).replace('\u2212', '-'));
    const wanted = truth[frame - 1]?.[column] ?? NaN;
    // Written to hundredths.
    assert(Math.abs(found - wanted) <= 0.00501, `${name} in frame ${frame}: ${found}, not ${wanted}`);
  }
}

/** @param {Page} page @param {Numbers[]} truth */
async function leads(page, truth) {
  const plot = joint(page).getByRole('img', { name: /^Flexion over frame/ });
  const box = await plot.boundingBox();
  assert(box);
  // Between the axis and the border frames are as wide as each other.
  const [left, width] = [box.x + 44, box.width - 52];
  const at = (/** @type {number} */ frame) => /** @type {const} */ ([left + ((frame - 0.5) / FRAMES) * width, box.y + box.height / 2]);
  await page.mouse.move(...at(2));
  await until(() => joint(page).getByRole('status', { name: 'Flexion in frame 2' }).count(), (count) => count === 1, 'the numbers of frame 2');
  await agrees(page, { Flexion: 'flexion_deg' }, 2, truth);
  await page.mouse.click(...at(3));
  await page.getByRole('application', { name: /frame 3 of 8/ }).waitFor();
  await page.mouse.move(box.x, box.y - 300);
  await page.keyboard.press('f');
  await until(() => joint(page).getByRole('status', { name: `Flexion in frame ${GAP}` }).count(), (count) => count === 1, 'the frame without a tibia');
  await until(() => shown(page, 'Flexion', GAP), (text) => text === '–', 'no number in the gap');
}

/** @param {Page} page */
async function overs(page) {
  await joint(page).getByRole('radio', { name: 'Time' }).press('Enter');
  await joint(page).getByText('Say how many frames there are in a second.').waitFor();
  await joint(page).getByRole('spinbutton', { name: 'Frames a second (1/s)' }).fill('15');
  await joint(page).getByRole('img', { name: /^Lift-off over time in 7 frames/ }).waitFor();
  await joint(page).getByRole('radio', { name: 'Flexion' }).press('Enter');
  await joint(page).getByRole('img', { name: /^Lowest AP over flexion in 7 frames/ }).waitFor();
  await joint(page).getByRole('button', { name: 'Abduction alone' }).press('Enter');
  await until(() => joint(page).getByRole('img').count(), (count) => count === 1, 'one curve');
  await joint(page).getByRole('button', { name: 'All curves' }).press('Enter');
  await until(() => joint(page).getByRole('img').count(), (count) => count === 9, 'all curves and the tray');
  const size = joint(page).getByRole('separator', { name: 'Height of the curves' });
  await size.press('ArrowUp');
  assert.equal(await until(() => size.getAttribute('aria-valuenow'), (now) => now !== '40', 'a higher dock'), '44');
}

/** @param {Page} page */
async function asksForSide(page) {
  await page.getByRole('combobox', { name: 'Side of the body' }).selectOption('side?');
  // One line needs no more room than that.
  await until(async () => (await page.getByRole('region', { name: 'Joint', exact: true }).boundingBox())?.height ?? 0, (height) => height < 120, 'a low dock');
  await joint(page).getByText('Which knee is it? Signs depend on it. The femur is made for a left one.').waitFor();
  await joint(page).getByRole('button', { name: 'Left' }).press('Enter');
  await joint(page).getByRole('img', { name: /^Flexion over flexion in 7 frames/ }).waitFor();
}

/** Six presses from the curves to table, figure and film. @param {Page} page @param {Numbers[]} truth */
async function saved(page, truth) {
  await page.getByRole('button', { name: /^Frame 1, femur/ }).click();
  await page.keyboard.press('y');
  await joint(page).getByRole('button', { name: 'Export…' }).press('Enter');
  const sheet = exportSheet(page);
  await sheet.getByRole('region', { name: 'Preview' }).waitFor();
  const faults = [
    '1 frame without a pose; they stay empty: 4',
    '7 frames with a pose from a file, which does not say how it was found: 1–3, 5–8',
    '7 frames of which nobody has checked both poses: 1–3, 5–8',
  ];
  await until(() => sheet.getByRole('listitem').allInnerTexts(), (texts) => isDeepStrictEqual(texts, faults), faults.join('; '));
  await screenshot(page, 'export joint');
  checkTable(await savedFile(page), truth);
  await openExport(page, 'Figure');
  await sheet.getByRole('img', { name: 'Preview' }).waitFor();
  await screenshot(page, 'export figure');
  const figure = (await savedFile(page)).buffer.toString();
  for (const letter of ['a', 'b', 'c', 'd']) assert(figure.includes(`font-weight="bold">${letter}</text>`), `panel ${letter}`);
  await openExport(page, 'Overlay film');
  await sheet.getByRole('img', { name: 'Preview' }).waitFor();
  await screenshot(page, 'export film');
  checkFilm(await savedFile(page));
  await otherForms(page);
}

/** Of every form that the numbers, the figure, the report and the film have. @param {Page} page */
async function otherForms(page) {
  const png = await forms(page, 'Figure', 'PNG');
  assert.deepEqual([...png.subarray(1, 4)], [...Buffer.from('PNG')]);
  assert.equal(png.readUInt32BE(16), Math.round((180 / 25.4) * 600));
  const pdf = (await forms(page, 'Figure', 'PDF')).toString('latin1');
  // 180 mm wide, letters as letters.
  for (const part of ['%PDF-', '/MediaBox [0 0 510.2', '/BaseFont /Helvetica', '%%EOF']) assert(pdf.includes(part), part);
  const motion = (await forms(page, 'Joint numbers', 'MOT')).toString();
  assert.match(motion, /nRows=8\nnColumns=19\ninDegrees=yes/);
  const cycle = (await forms(page, 'Joint numbers', '101 points')).toString();
  assert.equal(cycle.split('\n').filter((line) => line && !line.startsWith('#'))[0].split(',').length, 101);
  const pictures = unzipped({ buffer: await forms(page, 'Overlay film', 'PNG series') });
  assert.deepEqual(Object.keys(pictures), Array.from({ length: FRAMES }, (_, index) => `frame_000${index + 1}.png`));
  await calledOff(page);
  const tra = (await forms(page, 'Poses', 'TRA')).toString().trimEnd().split('\n');
  assert.deepEqual([tra.length, tra[GAP - 1].split(',').slice(16).every((number) => number === 'NaN')], [FRAMES, true]);
  const report = await openExport(page, 'Report');
  await report.getByRole('heading', { name: /: joint motion$/ }).waitFor();
  await screenshot(page, 'export report');
  const html = (await savedFile(page)).buffer.toString();
  for (const words of ['empty everywhere: 4', 'femoral model', '<svg', 'of which no person has checked both poses', 'Frames with a pose from a file']) assert(html.includes(words), words);
}

/** Nothing is written, and the page says so. @param {Page} page */
async function calledOff(page) {
  const sheet = await openExport(page, 'Overlay film', 'PNG series');
  // Eight pictures are written in a moment, sooner than a slow machine finds the button: the second one waits.
  const calls = await Calls.of(page, { method: 'add', most: 1 });
  await sheet.getByRole('button', { name: /^Save \S+\.zip$/ }).click();
  await page.getByRole('button', { name: 'Cancel: Writing the film' }).click();
  await panel.waitForWords(page, /^Called off: \S+ was not written/);
  await calls.letGo();
}

/** @param {Page} page @param {...string} choices */
async function forms(page, ...choices) {
  const [kind, ...others] = choices;
  await openExport(page, kind, ...others);
  return (await savedFile(page)).buffer;
}

/** A film in one of two containers, with as many pictures as frames. @param {import('./support/files.mjs').FileToOpen} film */
function checkFilm({ name, buffer }) {
  const isMp4 = buffer.subarray(4, 8).toString() === 'ftyp';
  const isWebM = buffer.readUInt32BE(0) === 0x1a45dfa3;
  assert(name.endsWith(isMp4 ? '_overlay.mp4' : '_overlay.webm') && (isMp4 || isWebM), name);
  assert(buffer.length > 20_000, `${buffer.length} bytes`);
}

/** @param {import('./support/files.mjs').FileToOpen} table @param {Numbers[]} truth */
function checkTable(table, truth) {
  assert.match(table.name, /_joint\.csv$/);
  const lines = table.buffer.toString().trimEnd().split('\n');
  const heading = lines.filter((line) => line.startsWith('#'));
  assert(heading.some((line) => /knee: left/.test(line)) && heading.some((line) => /Grood and Suntay 1983/.test(line)), heading.join('\n'));
  const [head, ...rows] = lines.slice(heading.length).map((line) => line.split(','));
  assert.equal(rows.length, FRAMES);
  const value = (/** @type {string} */ column, /** @type {number} */ frame) => rows[frame - 1][head.indexOf(column)];
  truth.forEach((numbers, index) => {
    assert.equal(value('frame', index + 1), String(index + 1));
    for (const [column, wanted] of Object.entries(numbers ?? {})) {
      const found = value(column, index + 1);
      assert(found !== 'NaN' && Math.abs(Number(found) - wanted) < 1e-4, `${column} in frame ${index + 1}: ${found}, not ${wanted}`);
      // Poses of a file come without standard deviations.
      assert.equal(value(`sd_${column}`, index + 1), 'NaN');
    }
  });
  assert.deepEqual(['flexion_deg', 'lift_off_mm', 'checked'].map((column) => value(column, GAP)), ['NaN', 'NaN', '0']);
  assert.deepEqual(['time_s', 'checked', 'doubt'].map((column) => value(column, 1)), ['0', '0', '""']);
}
