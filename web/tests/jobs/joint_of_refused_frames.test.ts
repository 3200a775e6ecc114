import { describe, expect, it, vi } from 'vitest';
import { addFrames, setSide } from '../../src/document/commands';
import { setPoseByHand } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { JointReader } from '../../src/jobs/joint_reader';

const poseOf = (x: number) => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });

function bench() {
  const store = new Store();
  let trouble: Error | null = null;
  const call = async (_: string, input: any) => {
    await Promise.resolve();
    if ('side' in input) return { columns: ['x'], hasPlate: false, plate: new Float64Array(), otherSide: null };
    if (trouble) throw trouble;
    return { numbers: Float64Array.from(input, ({ femur, tibia }: any) => 1000 * femur.pose.x + tibia.pose.x), impossible: input.map(() => null), originsApart: input.map(() => null) };
  };
  const reader = new JointReader({ store, studio: { meshOf: () => null } } as never, { call } as never);
  store.perform(addFrames([0, 1].map((k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }))));
  store.perform(setSide('left'));
  const set = (frame: number, component: 'femur' | 'tibia', x: number) => store.perform(setPoseByHand({ frameId: `f${frame}`, component }, poseOf(x)));
  for (const frame of [0, 1]) for (const component of ['femur', 'tibia'] as const) set(frame, component, 1);
  return { store, reader, set, fail: (error: Error | null) => void (trouble = error) };
}

describe('numbers of a frame that the worker refuses', () => {
  it('are not those of the pose before', async () => {
    const { store, reader, set, fail } = bench();
    store.setJoint({ open: true });
    await vi.waitFor(() => expect(reader.numbers.of.get('f1')?.[0]).toBe(1001));
    fail(new Error('a refusal'));
    set(1, 'femur', 50);
    await vi.waitFor(() => expect(store.ui.notice?.kind).toBe('error'));
    // Nothing waits any more, and what is told of f1 is of the pose before.
    expect({ row: reader.rowOf('f1')?.get('x') ?? null, curve: reader.numbers.of.get('f1')?.[0] ?? null, waiting: reader.numbers.waiting }).toEqual({ row: null, curve: null, waiting: 0 });
  });

  it('are worked out once the other pose of it is another', async () => {
    const { store, reader, set, fail } = bench();
    store.setJoint({ open: true });
    await vi.waitFor(() => expect(reader.numbers.of.get('f1')?.[0]).toBe(1001));
    fail(new Error('a refusal'));
    set(1, 'tibia', 7);
    await vi.waitFor(() => expect(store.ui.notice?.kind).toBe('error'));
    fail(null);
    set(1, 'tibia', 2);
    await vi.waitFor(() => expect(reader.numbers.of.get('f1')?.[0]).toBe(1002));
  });
});
