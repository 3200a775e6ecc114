import { describe, expect, it } from 'vitest';
import { Cells } from '../../src/document/cells';
import { addFrames } from '../../src/document/commands';
import { Store } from '../../src/document/store';
import { type Cell, cellKey, type Judged, type Outline, type Posed, UNMET } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import { MasksTold } from '../../src/jobs/masks_told';
import { isOff, masksOff } from '../../src/results/masks_off';

const MASK: Outline = { points: [framePoint(1, 1), framePoint(5, 1), framePoint(3, 6)], closed: true, unknownSides: [], laidBy: 'mask' };
const GOOD = { word: 'good', because: 'it fits' } as const;
const ANOTHER = { word: 'doubtful', because: 'is it another implant?' } as const;

function cell(verdict: Judged['verdict'] | null, more: Partial<Posed> = {}, outline = MASK): Cell {
  const pose = { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };
  const candidate = { pose, unmatched: null, drawn: null, residual: 1, deviations: null, judged: verdict && { misfit: 1, verdict } };
  const result: Posed = { kind: 'posed', from: 'outline', origin: 'k', candidates: [candidate], chosen: 0, reason: null, decided: true, verdict, onFrame: { film: [0.02, 1, 1] }, ...more };
  return { outline, result, resultOf: outline };
}

function film(cells: readonly Cell[]): Store {
  const store = new Store();
  store.perform(addFrames(cells.map((_, index) => ({ id: `f${index}`, name: `f${index}`, source: 's', indexInSource: index, width: 9, height: 9 }))));
  store.amend((doc) => ({ ...doc, cells: Cells.from(cells.map((one, index) => [cellKey(`f${index}`, 'femur'), one])) }));
  return store;
}

describe('masks that their frames do not bear out', () => {
  it('are told where they are many', () => {
    const [off, on] = [cell(ANOTHER), cell(GOOD)];
    expect(masksOff(film([off, off, off, on, on]).doc, 'femur')).toEqual({ off: 3, of: 5 });
    expect(masksOff(film([off, off, off]).doc, 'tibia')).toBeNull();
    // Single ones have reasons of their own.
    expect(masksOff(film([off, off, on]).doc, 'femur')).toBeNull();
    expect(masksOff(film([off, off, off, on, on, on, on]).doc, 'femur')).toBeNull();
  });

  it('are those whose frames were asked, and which these themselves speak against', () => {
    expect(isOff(cell(ANOTHER, { onFrame: { film: null } }))).toBe(false);
    expect(isOff(cell(ANOTHER, {}, { ...MASK, laidBy: 'hand' as never }))).toBe(false);
    // A rival is no word of the frame against the pose.
    expect(isOff(cell(GOOD, { verdict: { word: 'doubtful', because: 'another pose is open' } }))).toBe(false);
    expect(isOff(cell(null))).toBe(true);
    expect(isOff(cell(GOOD, { onFrame: { film: null }, verdict: UNMET }))).toBe(true);
  });

  it('are told once for an import, when the film is at rest', () => {
    const store = film([cell(ANOTHER), cell(ANOTHER), cell(ANOTHER)]);
    const told = new MasksTold(store);
    // As the reader of the film does it: whatever changes, it may be at rest.
    store.subscribe(() => told.rested());
    const rest = () => {
      store.show({ notice: null });
      told.rested();
      return store.ui.notice?.text ?? null;
    };
    expect(rest()).toBeNull();
    told.corrected('femur');
    expect(rest()).toMatch(/^3 of 3 masks of the femur do not lie on the edges of their frames: they may be of other frames\./);
    told.corrected('femur');
    expect(rest()).toBeNull();
  });
});
