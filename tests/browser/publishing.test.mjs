/** From a followed film to what is published of it, in six clicks; the command writes the same from the same poses. */
import assert from 'node:assert/strict';
import { decode } from 'fast-png';
import { atRest, pageTest, step, until, visit } from './support/browser.mjs';
import { exported, exportSheet, openExport, savedFile } from './support/exporting.mjs';
import { choose } from './support/files.mjs';
import { openFollowed } from './support/followed.mjs';
import { unzipped } from './support/masks.mjs';
import * as panel from './support/panel.mjs';
import { reported } from './support/report.mjs';
import { Stage } from './support/stage.mjs';
import { demoFile, framePath, trueOutline } from './support/study.mjs';
import * as tracing from './support/tracing.mjs';
import { picturesOf } from './support/video.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {import('./support/files.mjs').FileToOpen} FileToOpen */
/** @typedef {import('fast-png').DecodedPng} Picture */

/** Of the demonstration, as in `following.test.mjs`. */
const FRAMES = 3;

pageTest('what is published', async (page, t) => {
  const opened = await openFollowed(page, FRAMES);
  if (opened === null) await followed(page);
  /** @type {{ table: FileToOpen, figure: FileToOpen, film: FileToOpen }} */
  let saved;
  await step(page, t, 'is saved in six clicks', async () => {
    saved = await sixClicks(page);
  });
  await step(page, t, 'is what the command writes from the same poses', async () => {
    const frames = await Promise.all(Array.from({ length: FRAMES }, (_, index) => demoFile(framePath(index + 1))));
    const beside = await Promise.all(['calibration.txt', 'femur.stl', 'tibia.stl'].map(demoFile));
    await openExport(page, 'Session', 'Study file');
    const study = await savedFile(page);
    const written = await reported(study, await exported(page, 'Poses', 'For commands'), beside, frames);
    const table = saved.table.buffer.toString();
    assert.equal(table, (await written('joint.csv')).toString());
    assert.equal(deviationsIn(table), FRAMES);
    assert.equal(saved.figure.buffer.toString(), (await written('figure.svg')).toString());
    await sameFilm(saved.film, written, t);
    // The command's own film, read by a browser: as many frames in the same time.
    await sameFilm({ ...saved.film, name: 'overlay.webm', buffer: await written('overlay.webm') }, written, t);
  });
  await step(page, t, 'is in one file with all results', async () => {
    const files = unzipped(await exported(page, 'All results'));
    const poses = unzipped(await exported(page, 'Poses', 'For commands'));
    assert.deepEqual(Object.keys(files).sort(), ['figure.pdf', 'figure.svg', 'joint.csv', 'report.html', ...Object.keys(poses).map((name) => `poses/${name}`)].sort());
    const text = (/** @type {string} */ name) => Buffer.from(files[name]).toString();
    assert.equal(text('joint.csv'), saved.table.buffer.toString());
    assert.equal(text('figure.svg'), saved.figure.buffer.toString());
    assert.match(text('figure.pdf'), /^%PDF-/);
    assert.match(text('report.html'), /<table/);
    for (const [name, bytes] of Object.entries(poses)) assert.deepEqual(Buffer.from(files[`poses/${name}`]), Buffer.from(bytes));
  });
  await step(page, t, 'stays the next step when the session is opened again', async () => {
    const next = () => page.getByRole('list', { name: 'Steps' }).locator('[aria-current]').innerText();
    const before = await next();
    assert.notEqual(before, 'Follow');
    const session = await exported(page, 'Session', 'With images and models');
    await visit(page);
    await choose(page, session);
    await panel.waitForFrames(page, FRAMES);
    await panel.waitForLibraries(page, 'Femur', 'Tibia');
    await atRest(page);
    await until(next, (step) => step === before, `${before} to be next`);
    const again = await exported(page, 'Session', 'With images and models');
    const documentOf = (/** @type {FileToOpen} */ { buffer }) => JSON.parse(buffer.toString()).document;
    assert.deepEqual(documentOf(again), documentOf(session));
    // So is the film that another test has followed: what was published is what would have been published there.
    if (opened) assert.deepEqual(documentOf(session), documentOf(opened));
  });
});

/** Both components clicked, and the film followed. @param {Page} page */
async function followed(page) {
  await tracing.openDemonstration(page, FRAMES);
  const stage = new Stage(page);
  await stage.learn();
  for (const component of /** @type {const} */ (['femur', 'tibia'])) await stage.click(tracing.insideOf(await trueOutline(component, 1)));
  const card = page.getByRole('region', { name: 'What to do next' });
  await card.getByRole('button', { name: 'Follow the film' }).click();
  const isDone = (/** @type {string} */ cell) => /: followed(,|$)/.test(cell);
  await until(() => panel.cells(page), (cells) => cells.filter(isDone).length === 2 * (FRAMES - 1), 'the film to be followed');
  await atRest(page);
}

/** Frames whose flexion has a standard deviation. @param {string} table */
function deviationsIn(table) {
  const [head, ...rows] = table.split('\n').filter((line) => line && !line.startsWith('#')).map((line) => line.split(','));
  return rows.filter((row) => Number(row[head.indexOf('sd_flexion_deg')]) > 0).length;
}

/** @param {Page} page */
async function sixClicks(page) {
  const clicks = await tracing.countClicks(page);
  const sheet = exportSheet(page);
  await page.getByRole('button', { name: 'Export…' }).click();
  const table = await savedFile(page);
  await sheet.getByRole('radio', { name: 'Figure', exact: true }).click();
  const figure = await savedFile(page);
  await sheet.getByRole('radio', { name: 'Overlay film', exact: true }).click();
  const film = await savedFile(page);
  assert.equal(await clicks(), 6);
  assert.match([table, figure, film].map(({ name }) => name).join(' '), /_joint\.csv \S+_figure\.svg \S+_overlay\.(mp4|webm)$/);
  await sheet.press('Escape');
  return { table, figure, film };
}

/** More grey values from the command's picture are another picture; compression and pens take less than one. */
const SAME_GREY = 2;

/**
 * The X-ray with both outlines, frame by frame. The curves beside it are drawn by a canvas here and by our own lines there.
 *
 * @param {FileToOpen} film
 * @param {import('./support/report.mjs').Written} written
 * @param {import('node:test').TestContext} t
 */
async function sameFilm(film, written, t) {
  const shown = await picturesOf(film, FRAMES);
  const wanted = await Promise.all(shown.map(async (_, index) => decode(await written(`overlay/frame_000${index + 1}.png`))));
  const [{ width, height }] = wanted;
  assert.deepEqual(shown.map((picture) => [picture.width, picture.height]), wanted.map(() => [width, height]));
  const away = shown.map((picture) => wanted.map((other) => greyBetween(picture, other, height)));
  t.diagnostic(`grey values between film and pictures: ${away.map((row, index) => row[index].toFixed(2)).join(' ')}`);
  away.forEach((row, index) => {
    assert(row[index] < SAME_GREY, `frame ${index + 1} is ${row[index]} grey values away from the command's, whose others are ${row.map((one) => one.toFixed(2)).join(' ')} away`);
    row.forEach((other, at) => assert(at === index || other > 2 * row[index], `frame ${index + 1} is as near to the command's ${at + 1}: ${other}`));
  });
}

/** Mean difference over the square of the X-ray. @param {Picture} a @param {Picture} b @param {number} side px */
function greyBetween(a, b, side) {
  let sum = 0;
  for (let row = 0; row < side; row++) {
    for (let column = 0; column < side; column++) {
      const pixel = row * a.width + column;
      for (let k = 0; k < 3; k++) sum += Math.abs(a.data[pixel * a.channels + k] - b.data[pixel * b.channels + k]);
    }
  }
  return sum / (3 * side * side);
}
