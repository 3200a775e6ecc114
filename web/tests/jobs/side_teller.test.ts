import { describe, expect, it, vi } from 'vitest';
import { setAxes } from '../../src/document/axes';
import { setModel, setSide } from '../../src/document/commands';
import { Store } from '../../src/document/store';
import { SideTeller } from '../../src/jobs/side_teller';

const DIRECTIONS = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] as const;

/** A worker that answers as the test says. */
function bench(answer: () => Promise<unknown>) {
  const store = new Store();
  const call = vi.fn(answer);
  const studio = { meshOf: () => ({ vertices: new Float32Array(), triangles: new Uint32Array() }) };
  const teller = new SideTeller({ store, studio } as unknown as ConstructorParameters<typeof SideTeller>[0], { call } as unknown as ConstructorParameters<typeof SideTeller>[1]);
  return { store, call, teller };
}

describe('side teller', () => {
  it('tells which knee the femur is made for while nobody has said which it is, and asks once', async () => {
    const { store, call, teller } = bench(async () => 'right');
    store.perform(setModel('femur', { name: 'a.stl', sha256: 'a' }));
    expect(call).not.toHaveBeenCalled();
    store.perform(setAxes('femur', { directions: DIRECTIONS, from: 'shape', told: 'all' }));
    await vi.waitFor(() => expect(teller.told).toBe('right'));
    store.perform(setSide('left'));
    expect(teller.told).toBeNull();
    store.undo();
    expect(teller.told).toBe('right');
    expect(call).toHaveBeenCalledOnce();
  });

  it('asks nothing where the side is known or the front is not, and tells nothing of a mesh that is refused', async () => {
    const { store, call, teller } = bench(async () => { throw new Error('no triangles'); });
    store.perform(setSide('left'));
    store.perform(setModel('femur', { name: 'a.stl', sha256: 'a' }));
    store.perform(setAxes('femur', { directions: DIRECTIONS, from: 'shape', told: 'not the front' }));
    store.perform(setSide('unknown'));
    expect(call).not.toHaveBeenCalled();
    store.perform(setAxes('femur', { directions: DIRECTIONS, from: 'person', told: 'all' }));
    await vi.waitFor(() => expect(call).toHaveBeenCalledOnce());
    expect(teller.told).toBeNull();
  });
});
