import { describe, expect, it, vi } from 'vitest';
import { setAxes } from '../../src/document/axes';
import { setModel } from '../../src/document/commands';
import { Store } from '../../src/document/store';
import { Anatomist } from '../../src/jobs/anatomist';
import type { ComponentName } from '../../src/terms/component';
import { Aborted } from '../../src/workers/bridge';

const DIRECTIONS = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] as const;

/** Models are at hand as soon as they are named; a worker that answers as the test says. */
function bench(answer: () => Promise<unknown> = async () => ({ directions: DIRECTIONS, told: 'all' })) {
  const store = new Store();
  const asked: ComponentName[] = [];
  const meshes = new Set(['a', 'b']);
  const studio = { meshOf: (sha256: string) => (meshes.has(sha256) ? { vertices: new Float32Array(), triangles: new Uint32Array() } : null) };
  const call = async (_: string, { component }: { component: ComponentName }) => (asked.push(component), answer());
  new Anatomist({ store, studio } as unknown as ConstructorParameters<typeof Anatomist>[0], { call } as unknown as ConstructorParameters<typeof Anatomist>[1]);
  return { store, asked, meshes, axes: (component: ComponentName = 'femur') => store.doc.components[component].axes };
}

describe('anatomist', () => {
  it('asks once for each model, and what it takes is no unit of undo', async () => {
    const { store, asked, axes } = bench();
    store.perform(setModel('femur', { name: 'a.stl', sha256: 'a' }));
    await vi.waitFor(() => expect(axes()).toEqual({ directions: DIRECTIONS, from: 'shape', told: 'all' }));
    expect(store.state.history.past.length).toBe(1);
    store.perform(setModel('femur', { name: 'b.stl', sha256: 'b' }));
    await vi.waitFor(() => expect(axes()?.from).toBe('shape'));
    store.undo();
    expect(axes()?.from).toBe('shape');
    expect(asked).toEqual(['femur', 'femur']);
  });

  it('leaves alone what somebody said, and finds it again when that is taken back', async () => {
    const { store, asked, axes } = bench();
    store.perform(setAxes('femur', { directions: DIRECTIONS, from: 'study', told: 'all' }));
    store.perform(setModel('femur', { name: 'a.stl', sha256: 'a' }));
    expect(asked).toEqual([]);
    store.perform(setAxes('femur', null));
    await vi.waitFor(() => expect(axes()?.from).toBe('shape'));
  });

  it('waits for a model that is only named', async () => {
    const { store, asked, meshes, axes } = bench();
    store.perform(setModel('tibia', { name: 'c.stl', sha256: 'c' }));
    expect(asked).toEqual([]);
    meshes.add('c');
    store.show({});
    await vi.waitFor(() => expect(axes('tibia')?.told).toBe('all'));
  });

  it('says that nothing is told where the shape cannot be looked at, and asks again after being called off', async () => {
    const failing = bench(async () => { throw new Error('no triangles'); });
    failing.store.perform(setModel('femur', { name: 'a.stl', sha256: 'a' }));
    await vi.waitFor(() => expect(failing.axes()?.told).toBe('nothing'));
    expect(failing.asked.length).toBe(1);
    let first = true;
    const calledOff = bench(async () => {
      if (first) throw ((first = false), new Aborted());
      return { directions: DIRECTIONS, told: 'no signs' };
    });
    calledOff.store.perform(setModel('femur', { name: 'a.stl', sha256: 'a' }));
    await vi.waitFor(() => expect(calledOff.axes()?.told).toBe('no signs'));
  });
});
