/**
 * A left knee's numbers from its poses by nothing of ours: the field's formulas, Grood and Suntay's, and the lowest corners of
 * either half of the femoral component. The demonstration's files have the field's axes: x anterior, y superior, z right.
 */
import { trianglesOf } from './models.mjs';

/** @typedef {import('./study.mjs').Pose} Pose */
/** @typedef {[number, number, number]} Vector */
/** @typedef {{ rotation: [Vector, Vector, Vector], translation: Vector }} Placed */

/**
 * @param {Pose} femur
 * @param {Pose} tibia
 * @param {Buffer} femurFile an STL
 * @returns {Record<string, number>} by the names of the table's columns
 */
export function leftKnee(femur, tibia, femurFile) {
  const [a, b] = [placed(femur), placed(tibia)];
  // The tibial component in the femoral one's axes, by columns of the first.
  const m = /** @type {Vector[]} */ ([0, 1, 2].map((row) => [0, 1, 2].map((column) => dot(columnOf(a.rotation, row), columnOf(b.rotation, column)))));
  const t = /** @type {Vector} */ ([0, 1, 2].map((row) => dot(columnOf(a.rotation, row), less(b.translation, a.translation))));
  const [anterior, superior, medial] = [0, 1, 2].map((column) => -dot(columnOf(m, column), t));
  const along = columnOf(m, 1);
  const floating = /** @type {Vector} */ ([along[1], -along[0], 0].map((x) => x / Math.hypot(along[0], along[1])));
  return {
    field_anterior_mm: anterior,
    field_superior_mm: superior,
    field_medial_mm: medial,
    flexion_deg: -degrees(Math.atan2(-m[0][1], m[1][1])),
    abduction_deg: degrees(Math.asin(m[2][1])),
    internal_rotation_deg: -degrees(Math.atan2(-m[2][0], m[2][2])),
    gs_lateral_mm: -t[2],
    gs_anterior_mm: dot(t, floating),
    gs_distraction_mm: -dot(t, along),
    lift_off_mm: liftOff(a, b, femurFile),
  };
}

/** @param {Placed} femur @param {Placed} tibia @param {Buffer} file */
function liftOff(femur, tibia, file) {
  const corners = trianglesOf(file);
  const across = corners.flat().map(([, , z]) => z);
  const middle = (across.reduce((x, y) => Math.min(x, y)) + across.reduce((x, y) => Math.max(x, y))) / 2;
  const up = columnOf(tibia.rotation, 1);
  const lowest = { medial: Infinity, lateral: Infinity };
  for (const triangle of corners) {
    const half = (triangle[0][2] + triangle[1][2] + triangle[2][2]) / 3 >= middle ? 'medial' : 'lateral';
    for (const corner of triangle) {
      const there = femur.rotation.map((row, k) => dot(row, /** @type {Vector} */ (corner)) + femur.translation[k]);
      lowest[half] = Math.min(lowest[half], dot(up, less(/** @type {Vector} */ (there), tibia.translation)));
    }
  }
  return lowest.lateral - lowest.medial;
}

/** Turned about z, then x, then y. @param {Pose} pose @returns {Placed} */
function placed({ x, y, z, zRot, xRot, yRot }) {
  const [a, b, c] = [zRot, xRot, yRot].map((angle) => (angle * Math.PI) / 180);
  const [sa, ca, sb, cb, sc, cc] = [Math.sin(a), Math.cos(a), Math.sin(b), Math.cos(b), Math.sin(c), Math.cos(c)];
  return {
    rotation: [
      [ca * cc - sa * sb * sc, -sa * cb, ca * sc + sa * sb * cc],
      [sa * cc + ca * sb * sc, ca * cb, sa * sc - ca * sb * cc],
      [-cb * sc, sb, cb * cc],
    ],
    translation: [x, y, z],
  };
}

/** @param {readonly Vector[]} matrix @param {number} at @returns {Vector} */
function columnOf(matrix, at) {
  return [matrix[0][at], matrix[1][at], matrix[2][at]];
}

/** @param {Vector} a @param {Vector} b */
function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** @param {Vector} a @param {Vector} b @returns {Vector} */
function less(a, b) {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

/** @param {number} radians */
function degrees(radians) {
  return (radians * 180) / Math.PI;
}
