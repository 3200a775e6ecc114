/** Pictures of calibration grids, drawn here. */
import { encode } from 'fast-png';
import { file } from './files.mjs';

export const PLATE = { side: 640, spacing: 32, middle: 320 };

/** Pin-cushion of four percent at the edge: where an ideal place is seen. @param {[number, number]} place @returns {[number, number]} */
export function distorted([column, row]) {
  const [x, y] = [(column - 315) / 320, (row - 326) / 320];
  const grow = 1 + 0.04 * (x * x + y * y);
  return [315 + 320 * grow * x, 326 + 320 * grow * y];
}

/** A plate 1000 of 1200 mm from the source, 10 mm between beads, tilted by 12 degrees: where an ideal place is seen. @param {[number, number]} place @returns {[number, number]} */
export function tilted([column, row]) {
  const [x, y] = [column, row].map((at) => ((at - PLATE.middle) / PLATE.spacing) * 10);
  const [sin, cos] = [Math.sin(Math.PI / 15), Math.cos(Math.PI / 15)];
  const times = (PLATE.spacing / 10) * (1000 / (1000 + sin * x));
  return [PLATE.middle + times * cos * x, PLATE.middle + times * y];
}

/** The ideal place of a bead. @param {number} i to the right @param {number} j down @returns {[number, number]} */
export function ideal(i, j) {
  return [PLATE.middle + PLATE.spacing * i, PLATE.middle + PLATE.spacing * j];
}

/** A plate of dark beads of 4.5 px radius, distorted or not. @param {string} name @param {(place: [number, number]) => [number, number]} seen */
export function plate(name, seen = distorted) {
  const { side } = PLATE;
  const data = new Uint8Array(side * side).fill(180);
  for (let i = -11; i <= 11; i++) {
    for (let j = -11; j <= 11; j++) {
      const [column, row] = seen(ideal(i, j));
      for (let r = Math.floor(row - 9); r <= row + 9; r++) {
        for (let c = Math.floor(column - 9); c <= column + 9; c++) {
          if (c < 0 || r < 0 || c >= side || r >= side) continue;
          const away = Math.hypot(c + 0.5 - column, r + 0.5 - row) - 4.5;
          data[r * side + c] = Math.round(180 - 110 / (1 + Math.exp(2 * away)));
        }
      }
    }
  }
  return file(name, encode({ width: side, height: side, data, depth: 8, channels: 1 }));
}
