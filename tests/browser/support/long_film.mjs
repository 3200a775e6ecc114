/** A film of as many frames as one likes, of a knee that flexes and extends, with its poses: small frames, and nothing is to be found in them. */
import { drawn } from './browser.mjs';
import { choose, file } from './files.mjs';
import * as panel from './panel.mjs';
import { demoFile } from './study.mjs';

/** @typedef {import('playwright-core').Page} Page */

/** Sides of its frames, px, and of a pixel, mm: an image intensifier of 320 mm. */
const SIDE = 128;
const PITCH_MM = 2.5;
/** From the X-ray's focus to the detector, mm. */
const DISTANCE_MM = 1200;

/** @param {Page} page */
export function joint(page) {
  return page.getByRole('region', { name: 'Joint', exact: true });
}

/** The film with its poses and all numbers of a left knee. Gives the seconds that the numbers took. @param {Page} page @param {number} frames */
export async function openLongFilm(page, frames) {
  const film = longFilm(frames);
  await choose(page, film.frames, film.calibration, await demoFile('femur.stl'), await demoFile('tibia.stl'));
  await panel.waitForFrames(page, frames);
  await choose(page, film.femur, film.tibia);
  await page.keyboard.press('Shift+K');
  const left = joint(page).getByRole('button', { name: 'Left', exact: true });
  await left.or(joint(page).getByRole('img').first()).first().waitFor();
  if (await left.count()) await left.click();
  const from = performance.now();
  await joint(page).getByRole('img', { name: new RegExp(`^Lift-off over frame in ${frames} frames`) }).waitFor();
  await drawn(page);
  return (performance.now() - from) / 1000;
}

/** @param {number} frames */
function longFilm(frames) {
  const flexion = (/** @type {number} */ at) => 45 - 40 * Math.cos((4 * Math.PI * at) / frames);
  const rows = (/** @type {(at: number) => number[]} */ of) => Array.from({ length: frames }, (_, at) => of(at).map((x) => x.toFixed(6)).join(', '));
  const jts = (/** @type {string[]} */ lines) => ['JT_EULER_312', 'x_tran, y_tran, z_tran, z_rot, x_rot, y_rot', ...lines, ''].join('\n');
  return {
    frames: file('long.dcm', dicom(frames)),
    calibration: file('calibration.txt', `JT_INTCALIB\n${DISTANCE_MM}\n0\n0\n${PITCH_MM}\n`),
    femur: file('femur.jts', jts(rows((at) => [2 + Math.sin(at / 30), 24, -900, flexion(at), 1, -2]))),
    tibia: file('tibia.jts', jts(rows((at) => [0, -6 + 0.3 * Math.sin(at / 50), -902, 0, 0.5, 4 * Math.sin(at / 200)]))),
  };
}

/** 8-bit frames without compression, explicit little endian, after PS3.5 and PS3.10: a ramp that moves. @param {number} frames */
function dicom(frames) {
  const pixels = Buffer.alloc(frames * SIDE * SIDE);
  for (let frame = 0; frame < frames; frame++) {
    for (let row = 0; row < SIDE; row++) pixels.fill((40 + row + frame) % 200, (frame * SIDE + row) * SIDE, (frame * SIDE + row + 1) * SIDE);
  }
  const number = (/** @type {number} */ value) => Buffer.from([value & 255, value >> 8]);
  const even = (/** @type {string} */ text) => Buffer.from(text.length % 2 ? `${text} ` : text, 'latin1');
  const meta = Buffer.concat([element(0x0002, 0x0001, 'OB', Buffer.from([0, 1])), element(0x0002, 0x0010, 'UI', Buffer.from('1.2.840.10008.1.2.1\0'))]);
  const length = Buffer.alloc(4);
  length.writeUInt32LE(meta.length);
  return Buffer.concat([
    Buffer.alloc(128),
    Buffer.from('DICM'),
    element(0x0002, 0x0000, 'UL', length),
    meta,
    element(0x0018, 0x0040, 'IS', even('30')),
    element(0x0028, 0x0002, 'US', number(1)),
    element(0x0028, 0x0004, 'CS', even('MONOCHROME2')),
    element(0x0028, 0x0008, 'IS', even(`${frames}`)),
    element(0x0028, 0x0010, 'US', number(SIDE)),
    element(0x0028, 0x0011, 'US', number(SIDE)),
    element(0x0028, 0x0100, 'US', number(8)),
    element(0x0028, 0x0101, 'US', number(8)),
    element(0x0028, 0x0102, 'US', number(7)),
    element(0x0028, 0x0103, 'US', number(0)),
    element(0x7fe0, 0x0010, 'OW', pixels),
  ]);
}

/** @param {number} group @param {number} number @param {string} representation @param {Buffer} value of even length */
function element(group, number, representation, value) {
  const isLong = representation === 'OB' || representation === 'OW';
  const head = Buffer.alloc(isLong ? 12 : 8);
  head.writeUInt16LE(group, 0);
  head.writeUInt16LE(number, 2);
  head.write(representation, 4, 'latin1');
  if (isLong) head.writeUInt32LE(value.length, 8);
  else head.writeUInt16LE(value.length, 6);
  return Buffer.concat([head, value]);
}
