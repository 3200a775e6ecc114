import { describe, expect, it } from 'vitest';
import { marksOf, rangeOf, runsOf } from '../../src/workers/handlers/overlay_drawing';
import { uncertaintyArray, uncertaintyFrom } from '../../src/workers/protocol/pose_array';

describe('curves beside a film', () => {
  it('have no line across a gap', () => {
    expect(runsOf([NaN, 1, 2, NaN, NaN, 3])).toEqual([[1, 2], [5, 5]]);
    expect(runsOf([NaN])).toEqual([]);
  });

  it('hold all numbers, and draw flat what hardly changes', () => {
    const [low, high] = rangeOf([{ values: Float64Array.of(0, NaN, 10) }, { values: Float64Array.of(-10) }]);
    expect([low, high]).toEqual([-12, 12]);
    expect(rangeOf([{ values: Float64Array.of(5, 5.1) }]).map((end) => end.toFixed(2))).toEqual(['4.05', '6.05']);
    expect(rangeOf([{ values: Float64Array.of(NaN) }])).toEqual([0, 1]);
  });

  it('have a few round marks', () => {
    expect(marksOf(-12, 12)).toEqual([-10, 0, 10]);
    expect(marksOf(4.05, 6.05)).toEqual([4.5, 5, 5.5, 6]);
    expect(marksOf(0, 1)).toEqual([0, 0.5, 1]);
  });
});

describe('how uncertain a pose is', () => {
  const deviations = { x: 1, y: 2, z: 3, zRot: 4, xRot: 5, yRot: 6 };
  /** 21 of the covariance, and 12 of the film. */
  const covariance = Array.from({ length: 33 }, (_, k) => k / 10);

  it('crosses over whole', () => {
    const there = uncertaintyArray({ ...deviations, covariance });
    expect(uncertaintyFrom(Float64Array.from(there))).toEqual({ ...deviations, covariance });
    expect(uncertaintyFrom(undefined)).toBeNull();
  });

  it('is NaN where it is not known, of old sessions the film or all of the covariance', () => {
    const older = uncertaintyArray({ ...deviations, covariance: covariance.slice(0, 21) });
    expect([older.length, older[26], older.slice(27).every(Number.isNaN)]).toEqual([39, 2, true]);
    const old = uncertaintyArray(deviations);
    expect([old.length, old[5], old.slice(6).every(Number.isNaN)]).toEqual([39, 6, true]);
    expect(uncertaintyArray(null).every(Number.isNaN)).toBe(true);
  });
});
