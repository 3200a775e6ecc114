import { expect, it } from 'vitest';
import { numbersAt } from '../../src/painting/wasm_view';

it('shows numbers where they lie, for as long as the memory does not grow', () => {
  const memory = new WebAssembly.Memory({ initial: 1 });
  const view = numbersAt(memory, 64, 3);
  new Float64Array(memory.buffer).set([1, 2, 3, 4], 8);
  expect([...view]).toEqual([1, 2, 3]);
  memory.grow(1);
  expect(view.length).toBe(0);
  expect([...numbersAt(memory, 72, 2)]).toEqual([2, 3]);
});
