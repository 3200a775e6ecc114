import { expect, it } from 'vitest';
import { buffersIn } from '../../src/workers/handlers/buffers';

it('finds the buffers of a message however deep they lie, each once', () => {
  const numbers = new Float64Array(4);
  const bits = new Uint8Array(2);
  const message = { id: 1, none: null, text: 'x', candidates: [{ picture: { bits } }, { picture: null }], numbers, half: numbers.subarray(2) };
  expect(buffersIn(message)).toEqual([bits.buffer, numbers.buffer]);
  expect(buffersIn(undefined)).toEqual([]);
});
