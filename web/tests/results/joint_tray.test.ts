import { describe, expect, it } from 'vitest';
import { addFrames, setSide } from '../../src/document/commands';
import { Store } from '../../src/document/store';
import type { JointNumbers } from '../../src/results/joint_curves';
import { trayOf } from '../../src/results/joint_tray';

const COLUMNS = ['medial_ap_mm', 'lateral_ap_mm', 'medial_across_mm', 'lateral_across_mm'];

function numbers(rows: readonly (readonly number[])[]): JointNumbers {
  const of = new Map(rows.map((row, k) => [`f${k}`, Float64Array.from(row)]));
  return { columns: COLUMNS, hasPlate: true, plate: Float64Array.of(25, 0, 0, 38, NaN, NaN, -25, 0, 0, -38), otherSide: null, of, impossible: new Map([['f2', 'no knee']]), originsApart: null, waiting: 0 };
}

function film(side: 'left' | 'right'): Store {
  const store = new Store();
  store.perform(addFrames(Array.from({ length: 4 }, (_, k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }))));
  store.perform(setSide(side));
  return store;
}

const ROWS = [
  [3, -4, 24, -22],
  [NaN, NaN, NaN, NaN],
  [500, 0, 24, -22],
  [5, -30, 24, -22],
];

describe('the tray from above', () => {
  it('has anterior up and the medial condyle of a left knee at the right, of a right one at the left', () => {
    for (const [side, sign] of [['left', 1], ['right', -1]] as const) {
      const tray = trayOf(film(side).doc, numbers(ROWS))!;
      expect(tray.border.map(([x, y]) => [sign * x + 0, y + 0])).toEqual([[0, -25], [38, 0], [0, 25], [-38, 0]]);
      expect(tray.lines.map(({ index }) => index)).toEqual([0, 3]);
      expect(tray.lines[0]).toMatchObject({ medial: [sign * 24, -3], lateral: [-sign * 22, 4] });
      expect(tray.medialSide).toBe(sign);
    }
  });

  it('is seen whole, with lines that reach beyond it', () => {
    const { middle, reach } = trayOf(film('left').doc, numbers(ROWS))!;
    expect([middle[1] - reach[1], middle[1] + reach[1]]).toEqual([-28, 33]);
  });

  it('is not there without a plate or a side', () => {
    expect(trayOf(film('left').doc, { ...numbers(ROWS), plate: new Float64Array() })).toBeNull();
    expect(trayOf(new Store().doc, numbers(ROWS))).toBeNull();
  });
});
