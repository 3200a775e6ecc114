/** The demonstration's files as the page serves them: what is true, for tests to compare with. */
import { contours } from 'd3-contour';
import { decode } from 'fast-png';
import simplify from 'simplify-js';
import { ADDRESS } from './browser.mjs';

/** @typedef {{ x: number, y: number, z: number, zRot: number, xRot: number, yRot: number }} Pose mm and degrees */
/** @typedef {[number, number]} Point column and row on the frame */

/** How far a traced polygon may leave the true border, px: a careful hand, 40 to 50 clicks. */
const HAND = 1;

/**
 * What such a polygon of the femur, clicked on whole screen pixels of a frame that has been zoomed in, has to give: a
 * little over the worst of the demonstration's 8 frames at scales of 2 and 2.8 (0.17 mm, 3.0 mm, 0.38 degrees).
 *
 * @type {Pose}
 */
export const HAND_TRACED = { x: 0.25, y: 0.25, z: 4, zRot: 0.5, xRot: 0.5, yRot: 0.5 };

/**
 * One file of the demonstration.
 *
 * @param {string} path
 * @returns {Promise<{ name: string, mimeType: string, buffer: Buffer }>}
 */
export async function demoFile(path) {
  const response = await fetch(`${ADDRESS}demo/${path}`);
  if (!response.ok) throw new Error(`the server has no demo/${path} (${response.status})`);
  const buffer = Buffer.from(await response.arrayBuffer());
  return { name: path.split('/').at(-1) ?? path, mimeType: 'application/octet-stream', buffer };
}

/** @param {number} frame from 1 */
export function framePath(frame) {
  return `frames/${String(frame).padStart(4, '0')}.png`;
}

/**
 * The known pose of a component.
 *
 * @param {'femur' | 'tibia'} component
 * @param {number} frame from 1
 */
export async function truePose(component, frame) {
  const poses = readJts((await demoFile(`${component}.jts`)).buffer.toString());
  const pose = poses[frame - 1];
  if (!pose) throw new Error(`${component}.jts has no row ${frame}`);
  return pose;
}

/**
 * The poses of a `.jts` file, read by nothing of ours: of a frame without one, six times NaN.
 *
 * @param {string} text
 * @returns {Pose[]}
 */
export function readJts(text) {
  const [kind, columns, ...rows] = text.trim().split(/\r?\n/).map((line) => line.trim());
  if (kind !== 'JT_EULER_312') throw new Error(`a .jts file should begin with JT_EULER_312, this one with ${kind}`);
  const names = columns?.split(/\s*,\s*/).join(' ');
  if (names !== 'x_tran y_tran z_tran z_rot x_rot y_rot') throw new Error(`unexpected columns: ${names}`);
  return rows.map((row) => {
    const values = row.split(/\s*,\s*/).map(Number);
    if (values.length !== 6 || row.split(/\s*,\s*/).some((text, at) => Number.isNaN(values[at]) && text !== 'NaN')) throw new Error(`not six numbers: ${row}`);
    const [x, y, z, zRot, xRot, yRot] = values;
    return /** @type {Pose} */ ({ x, y, z, zRot, xRot, yRot });
  });
}

/**
 * The polygon a careful hand would click around a component: the border of its true mask with as few points as stay
 * within `HAND` of it.
 *
 * @param {'femur' | 'tibia'} component
 * @param {number} frame from 1
 * @returns {Promise<Point[]>}
 */
export async function trueOutline(component, frame) {
  return polygonWithin(component, frame, HAND);
}

/**
 * The same with as few points as stay within so many pixels of the border.
 *
 * @param {'femur' | 'tibia'} component
 * @param {number} frame from 1
 * @param {number} away px
 * @returns {Promise<Point[]>}
 */
export async function polygonWithin(component, frame, away) {
  const name = String(frame).padStart(4, '0');
  const { width, height, data } = decode((await demoFile(`masks/${component}/${name}.png`)).buffer);
  const inside = Array.from(data, (value) => (value > 0 ? 1 : 0));
  // As on the page: the first pixel covers [0, 1), its centre is at 0.5.
  const [border] = contours().size([width, height]).thresholds([0.5])(inside);
  const rings = border.coordinates.map(([outer]) => outer);
  const ring = rings.reduce((longest, other) => (other.length > longest.length ? other : longest));
  const kept = simplify(ring.map(([x, y]) => ({ x, y })), away, true);
  // A ring ends where it begins.
  return kept.slice(0, -1).map(({ x, y }) => [x, y]);
}
