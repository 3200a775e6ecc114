import { describe, expect, it, vi } from 'vitest';
import { addFrames, withCell } from '../../src/document/commands';
import { plainDoc, readDoc } from '../../src/document/session/session';
import { Store } from '../../src/document/store';
import { type Candidate, cellOf, type Posed, type Verdict, verdictAlone, verdictOf } from '../../src/document/types';
import { asJob } from '../../src/jobs/services';
import { DetourWatch } from '../../src/jobs/detour_watch';
import type { PoseProtocol } from '../../src/workers/protocol/pose';

type Asked = PoseProtocol['offTheWay']['input'];

const GOOD: Verdict = { word: 'good', because: 'it fits' };

function posed(yRot: number, verdict = GOOD): Posed {
  const candidate: Candidate = { pose: { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot }, unmatched: 1, drawn: 1, residual: 0.3, deviations: null, judged: { misfit: 0.4, verdict } };
  return { kind: 'posed', from: 'outline', origin: 'k', candidates: [candidate], chosen: 0, reason: null, decided: true, verdict };
}

/** Three frames; a worker that tells poses that are turned by more than 90 degrees. */
function bench() {
  const store = new Store();
  const asked: (readonly (number | null)[])[] = [];
  const call = async (_: string, { poses }: Asked) => {
    asked.push(poses.map((pose) => pose?.yRot ?? null));
    return poses.map((pose) => (pose && pose.yRot > 90 ? `turned by ${pose.yRot}` : null));
  };
  new DetourWatch(store, { call } as unknown as ConstructorParameters<typeof DetourWatch>[1]);
  store.perform(addFrames(['a', 'b', 'c'].map((id) => ({ id, name: id, source: id, indexInSource: 0, width: 10, height: 10 }))));
  const put = (frameId: string, result: Posed | null) => store.amend((doc) => withCell(doc, { frameId, component: 'femur' }, { outline: null, result, resultOf: null }));
  const result = (frameId: string) => cellOf(store.doc, frameId, 'femur').result;
  return { store, asked, put, result };
}

describe('detour watch', () => {
  it('makes a pose doubtful that its film does not go through, and takes it back when it does', async () => {
    const { put, result } = bench();
    put('a', posed(1));
    put('b', posed(120));
    await vi.waitFor(() => expect(verdictOf(result('b'))).toEqual({ word: 'doubtful', because: 'turned by 120' }));
    expect(verdictOf(result('a'))).toEqual(GOOD);
    expect(verdictAlone(result('b'))).toEqual(GOOD);
    put('b', { ...posed(2), detour: 'turned by 120' });
    await vi.waitFor(() => expect(result('b')).not.toHaveProperty('detour'));
  });

  it('asks about good poses alone, and of what is doubtful by itself takes back what was told', async () => {
    const { put, result, asked } = bench();
    put('a', posed(120));
    await vi.waitFor(() => expect(result('a')).toHaveProperty('detour'));
    const doubtful: Verdict = { word: 'doubtful', because: 'ambiguous' };
    put('a', { ...posed(120, doubtful), detour: 'turned by 120' });
    await vi.waitFor(() => expect(verdictOf(result('a'))).toEqual(doubtful));
    expect(asked.at(-1)).toEqual([null, null, null]);
  });

  it('waits while poses are being found, and asks nothing where no pose has changed', async () => {
    const { store, put, asked } = bench();
    // Both components' films, which are empty.
    await vi.waitFor(() => expect(asked).toHaveLength(2));
    let end = () => {};
    const found = new Promise<void>((resolve) => (end = resolve));
    void asJob(store, { title: 'Follow', unit: 'frames', total: 2, cancel: () => undefined }, () => found);
    put('a', posed(1));
    await Promise.resolve();
    expect(asked).toHaveLength(2);
    end();
    await vi.waitFor(() => expect(asked.at(-1)).toEqual([1, null, null]));
    store.show({ tool: 'trace' });
    await Promise.resolve();
    expect(asked).toHaveLength(3);
  });

  it('is kept with the work, and stays out of what can be undone', async () => {
    const { store, put, result } = bench();
    const steps = store.state.history.past.length;
    put('a', posed(120));
    await vi.waitFor(() => expect(result('a')).toHaveProperty('detour'));
    expect(store.state.history.past).toHaveLength(steps);
    const again = readDoc(JSON.parse(JSON.stringify(plainDoc(store.doc))), 'work');
    expect(verdictOf(cellOf(again, 'a', 'femur').result)?.because).toBe('turned by 120');
  });
});
