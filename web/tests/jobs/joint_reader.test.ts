import { describe, expect, it, vi } from 'vitest';
import { addFrames, setSide } from '../../src/document/commands';
import { setPoseByHand } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { JointReader } from '../../src/jobs/joint_reader';
import { COMPONENT_NAMES } from '../../src/terms/component';
import { WorkerStopped } from '../../src/workers/bridge';
import type { JointProtocol, Uncertain } from '../../src/workers/protocol/joint';

const FRAMES = 40;
const poseOf = (x: number) => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });

/** A knee without models, and a worker whose one number is the x of the femur: it fails with the next trouble. */
function bench(troubles: Error[] = []) {
  const store = new Store();
  const calls: { method: string; frames: number; side?: string }[] = [];
  const call = async (method: string, input: JointProtocol['openJoint']['input'] | JointProtocol['joint']['input']) => {
    calls.push('side' in input ? { method, frames: 0, side: input.side } : { method, frames: input.length });
    await Promise.resolve();
    const trouble = troubles.shift();
    if (trouble) throw trouble;
    if ('side' in input) return { columns: ['x'], hasPlate: false, plate: new Float64Array(), otherSide: null };
    const frames = input as readonly { femur: Uncertain }[];
    return { numbers: Float64Array.from(frames, ({ femur }) => femur.pose.x), impossible: frames.map(({ femur }) => (femur.pose.x === 7 ? 'no knee does it' : null)), originsApart: frames.map(({ femur }) => (femur.pose.x >= 6 ? 100 + femur.pose.x : null)) };
  };
  const reader = new JointReader({ store, studio: { meshOf: () => null } } as unknown as ConstructorParameters<typeof JointReader>[0], { call } as unknown as ConstructorParameters<typeof JointReader>[1]);
  store.perform(addFrames(Array.from({ length: FRAMES }, (_, k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }))));
  store.perform(setSide('left'));
  for (let k = 0; k < FRAMES; k++) for (const component of COMPONENT_NAMES) set(store, k, component, k);
  const asked = () => calls.filter(({ method }) => method === 'joint').map(({ frames }) => frames);
  const rest = () => vi.waitFor(() => expect([reader.numbers.waiting, reader.numbers.of.size]).toEqual([0, FRAMES]));
  return { store, reader, calls, asked, rest };
}

function set(store: Store, frame: number, component: 'femur' | 'tibia', x: number): void {
  store.perform(setPoseByHand({ frameId: `f${frame}`, component }, poseOf(x)));
}

describe('the reader of the joint', () => {
  it('works nothing out before somebody looks, and then every frame once', async () => {
    const { store, reader, calls, asked, rest } = bench();
    expect(calls).toEqual([]);
    store.setJoint({ open: true });
    await rest();
    expect(asked()).toEqual([32, 8]);
    expect(reader.numbers.of.get('f35')?.[0]).toBe(35);
    expect([...reader.numbers.impossible]).toEqual([['f7', 'no knee does it']]);
    // Of frames that a knee may have alone.
    expect(reader.numbers.originsApart).toBe(106);
    expect(reader.numbers).toBe(reader.numbers);
  });

  it('works one frame out that somebody rests on, and has no numbers of it that no knee has, or of other poses', async () => {
    const { store, reader, asked } = bench();
    for (const id of ['f5', 'f7']) await reader.lookAt(id);
    expect(asked()).toEqual([1, 1]);
    expect(reader.rowOf('f5')).toEqual(new Map([['x', 5]]));
    expect([reader.rowOf('f7'), reader.rowOf('f6')]).toEqual([null, null]);
    expect(['f5', 'f6', 'f7'].map((id) => reader.impossibleIn(id))).toEqual([null, null, 'no knee does it']);
    set(store, 5, 'tibia', 100);
    expect(reader.rowOf('f5')).toBe(null);
    await reader.lookAt('f5');
    expect(reader.rowOf('f5')).toEqual(new Map([['x', 5]]));
    store.perform(setSide('right'));
    expect(reader.rowOf('f5')).toBe(null);
  });

  it('says where a frame could not be asked yet, as something else is being worked out', async () => {
    const { reader } = bench();
    const first = reader.lookAt('f5');
    expect(await reader.lookAt('f6')).toBe(false);
    expect(await first).toBe(true);
    expect(await reader.lookAt('f6')).toBe(true);
  });

  it('works a frame out again whose pose has changed', async () => {
    const { store, reader, asked, rest } = bench();
    store.setJoint({ open: true });
    await rest();
    set(store, 7, 'femur', 100);
    expect(reader.numbers.waiting).toBe(1);
    await rest();
    expect(reader.numbers.of.get('f7')?.[0]).toBe(100);
    expect(asked()).toEqual([32, 8, 1]);
  });

  it('begins anew for the other side, and shows nothing of the one before', async () => {
    const { store, reader, calls, rest } = bench();
    store.setJoint({ open: true });
    await rest();
    store.perform(setSide('right'));
    expect(reader.numbers.of.size).toBe(0);
    await rest();
    expect(calls.flatMap(({ side }) => side ?? [])).toEqual(['left', 'right']);
  });

  it('opens the joint again in a worker that was started anew', async () => {
    const { store, calls, rest } = bench([new WorkerStopped('gone')]);
    store.setJoint({ open: true });
    await rest();
    expect(calls.filter(({ side }) => side)).toHaveLength(2);
    expect(store.ui.notice).toBeNull();
  });

  it('says what was refused, and does not ask for ever', async () => {
    const { store, reader, calls } = bench([new Error('no right-handed frame')]);
    store.setJoint({ open: true });
    await vi.waitFor(() => expect(store.ui.notice?.text).toBe('no right-handed frame'));
    store.show({});
    await Promise.resolve();
    expect(calls).toHaveLength(1);
    expect(reader.numbers.of.size).toBe(0);
  });
});
