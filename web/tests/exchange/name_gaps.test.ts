import { describe, expect, it } from 'vitest';
import { gapsIn } from '../../src/exchange/name_gaps';

const named = (numbers: readonly number[]) => numbers.map((number) => `k2_${String(number).padStart(3, '0')}.png`);

/** The cases of `xtask/laboratory/src/files/listing.rs`. */
describe('what is missing among numbered names', () => {
  it('is told, with the names on both sides', () => {
    expect(gapsIn(named([0, 1, 2, 3, 4, 6, 7]))).toEqual({ missing: 1, between: [['k2_004.png', 'k2_006.png']] });
    expect(gapsIn(named([0, 4, 8, 20, 24, 28, 36]))).toEqual({ missing: 3, between: [['k2_008.png', 'k2_020.png'], ['k2_028.png', 'k2_036.png']] });
    expect(gapsIn(['f0.png', 'f1.png', 'f2.png', 'f4.png', 'f5.png', 'f6.png', 'f7.png', 'f9.png', 'f10.png'])?.missing).toBe(2);
  });

  it.each([[[5, 6, 7, 8]], [[0, 4, 8, 12]], [[0, 3, 4, 9, 11]], [[1, 2, 5]], [[]]])('is not made up of %j', (numbers) => {
    expect(gapsIn(named(numbers))).toBeNull();
  });

  it('is not told of names that differ in more than a number', () => {
    expect(gapsIn(['a1.png', 'b2.png', 'c4.png', 'd5.png'])).toBeNull();
    expect(gapsIn(['s1_1.png', 's1_2.png', 's2_3.png', 's2_5.png', 's2_6.png'])).toBeNull();
  });
});
