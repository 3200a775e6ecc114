import { describe, expect, it } from 'vitest';
import { stretchInView } from '../../src/controls/in_view';

describe('what is in sight', () => {
  it('of a few things is all of them', () => {
    expect(stretchInView(0, 1000, 5, 200)).toEqual({ first: 0, last: 200 });
    expect(stretchInView(0, 0, 0, 2000)).toEqual({ first: 0, last: 2000 });
  });

  it('of many is what the screen shows and some beside it, wherever it is scrolled to', () => {
    const [room, size, count] = [1000, 3, 2000];
    for (let offset = 0; offset <= count * size - room; offset += 7) {
      const { first, last } = stretchInView(offset, room, size, count);
      expect(first * size).toBeLessThanOrEqual(offset);
      expect(last * size).toBeGreaterThanOrEqual(offset + room);
      expect(last - first).toBeLessThan(600);
      expect(last).toBeLessThanOrEqual(count);
    }
  });

  it('stays within what there is where it was scrolled beyond it', () => {
    expect(stretchInView(1e6, 1000, 3, 500)).toEqual({ first: 500, last: 500 });
  });
});
