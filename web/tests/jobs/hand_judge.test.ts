import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { addFrames, addPoint, closeOutline, loadPoses, setCalibration, setModel } from '../../src/document/commands';
import type { Place } from '../../src/document/command';
import { setPoseByHand } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { cellOf, verdictOf, type Verdict } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import type { PoseNumbers } from '../../src/geometry/pose_numbers';
import { HAND_REST, HandJudge } from '../../src/jobs/hand_judge';
import { keepLibraryOpen } from './open_library';

const PLACE: Place = { frameId: 'f', component: 'femur' };
const poseOf = (x: number): PoseNumbers => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });

/** A frame whose pixels are at hand or not, and a worker that gives the next verdict. */
function bench({ pixels = true } = {}) {
  const store = new Store();
  const asked: { method: string; pose: PoseNumbers }[] = [];
  const verdicts: Verdict[] = [];
  const call = async (method: string, { pose }: { pose: PoseNumbers }) => {
    asked.push({ method, pose });
    return verdicts.shift() ?? { word: 'doubtful', because: `as ${method} says` };
  };
  const studio = { framePixels: () => (pixels ? { pixels: new Uint8Array(4), width: 2, height: 2, covered: new Uint32Array() } : null) };
  new HandJudge({ store, studio } as unknown as ConstructorParameters<typeof HandJudge>[0], { call } as unknown as ConstructorParameters<typeof HandJudge>[1]);
  store.perform(addFrames([{ id: 'f', name: 'f', source: 's', indexInSource: 0, width: 100, height: 100 }]));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
  keepLibraryOpen(store, 'femur');
  const verdict = () => verdictOf(cellOf(store.doc, 'f', 'femur').result);
  const trace = () => {
    for (const [column, row] of [[10, 10], [50, 10], [30, 60]] as const) store.perform(addPoint(PLACE, framePoint(column, row)));
    store.perform(closeOutline(PLACE));
  };
  return { store, asked, verdicts, verdict, trace };
}

const rest = () => vi.advanceTimersByTimeAsync(HAND_REST);

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe('the judge of poses by hand', () => {
  it('waits for the hand to rest, asks the frame where there is no outline, and makes no unit of undo', async () => {
    const { store, asked, verdict } = bench();
    store.perform(setPoseByHand(PLACE, poseOf(1), 'a', 'drag'));
    await vi.advanceTimersByTimeAsync(HAND_REST - 10);
    store.perform(setPoseByHand(PLACE, poseOf(2), 'a', 'drag'));
    await vi.advanceTimersByTimeAsync(HAND_REST - 10);
    expect(asked).toEqual([]);
    const units = store.state.history.past.length;
    await rest();
    expect(asked).toEqual([{ method: 'judgeOnFrame', pose: poseOf(2) }]);
    expect(verdict()).toEqual({ word: 'doubtful', because: 'as judgeOnFrame says' });
    expect(store.state.history.past.length).toBe(units);
    await vi.advanceTimersByTimeAsync(10 * HAND_REST);
    expect(asked.length).toBe(1);
  });

  it('asks the outline once there is a closed one; undo brings back what the frame said', async () => {
    const { store, asked, verdicts, verdict, trace } = bench();
    store.perform(setPoseByHand(PLACE, poseOf(1)));
    await rest();
    trace();
    verdicts.push({ word: 'good', because: 'it fits' });
    await rest();
    expect(asked.map(({ method }) => method)).toEqual(['judgeOnFrame', 'judgeOutline']);
    expect(verdict()?.word).toBe('good');
    store.undo();
    expect(verdict()).toEqual({ word: 'doubtful', because: 'as judgeOnFrame says' });
    await rest();
    expect(asked.length).toBe(2);
  });

  it('asks the frame of poses that came in a file, at once, and keeps what it says', async () => {
    const { store, asked, verdict } = bench();
    store.perform(loadPoses('femur', [poseOf(7)], 'femur.jts'));
    await vi.advanceTimersByTimeAsync(1);
    expect(asked).toEqual([{ method: 'judgeOnFrame', pose: poseOf(7) }]);
    expect(verdict()).toEqual({ word: 'doubtful', because: 'as judgeOnFrame says' });
    await vi.advanceTimersByTimeAsync(10 * HAND_REST);
    expect(asked.length).toBe(1);
  });

  it('says nothing where nothing can be held against the pose, and asks no more', async () => {
    const { store, asked, verdict } = bench({ pixels: false });
    store.perform(setPoseByHand(PLACE, poseOf(1)));
    await vi.advanceTimersByTimeAsync(10 * HAND_REST);
    expect(asked).toEqual([]);
    expect(verdict()).toBeNull();
  });
});
