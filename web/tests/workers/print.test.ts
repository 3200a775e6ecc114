import { expect, it } from 'vitest';
import { printOf } from '../../src/workers/handlers/print';

it('tells pictures that differ in one pixel, and not those that are the same', () => {
  const picture = Uint16Array.from({ length: 1001 }, (_, at) => (at * at) % 4096);
  expect(printOf(picture)).toBe(printOf(picture.slice()));
  for (const at of [0, 500, 1000]) {
    const other = picture.slice();
    other[at]! ^= 1;
    expect(printOf(other)).not.toBe(printOf(picture));
  }
  expect(printOf(new Uint8Array(8))).not.toBe(printOf(new Uint8Array(12)));
});
