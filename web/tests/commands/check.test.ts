import { describe, expect, it, vi } from 'vitest';
import { isInCheck, runCheckKey } from '../../src/commands/check_keys';
import { WorkActions } from '../../src/commands/work_actions';
import { addFrames, chooseCandidate, withCell } from '../../src/document/commands';
import { bare } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { cellOf, type Posed } from '../../src/document/types';
import { doubtsOf } from '../../src/results/doubts';
import { spanToFollow } from '../../src/results/spans';
import { standingOf } from '../../src/results/steps';

const poseOf = (x: number) => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });
const place = (frame: number) => ({ frameId: `f${frame}`, component: 'femur' as const });

/** Five frames: one clicked, the others followed from it, each as bad as is said; 0 is good. */
function bench(doubts: readonly number[]) {
  const store = new Store();
  store.perform(addFrames(doubts.map((_, k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }))));
  doubts.forEach((doubt, frame) => {
    const verdict = { word: doubt > 0 ? 'doubtful' : 'good', because: 'of its mirror image' } as const;
    const from = frame === 0 ? 'outline' : 'film';
    const result: Posed = { kind: 'posed', from, origin: 'o', candidates: [bare(poseOf(frame)), bare(poseOf(-frame))], chosen: 0, reason: null, decided: true, verdict, doubt };
    store.perform({ label: 'find', apply: (doc) => withCell(doc, place(frame), { outline: null, result, resultOf: null }) });
  });
  const work = new WorkActions({ store } as never);
  const chosen = vi.fn((index: number) => (store.perform(chooseCandidate(place(store.ui.frameIndex), index)), true));
  const press = (key: string) => runCheckKey({ actions: { chooseCandidate: chosen }, services: { store } } as never, { key, ctrl: false, shift: false, alt: false });
  return { store, work, chosen, press };
}

describe('what is doubtful', () => {
  it('is gone through from the worst: first what others were followed from', () => {
    const { store } = bench([2, 1.1, 0, 3]);
    expect(doubtsOf(store.doc).map(({ index }) => index)).toEqual([0, 3, 1]);
  });

  it('is accepted by Y, which goes on, and left for later by N', () => {
    const { store, work } = bench([0, 1.1, 1.5, 3]);
    expect(isInCheck(store.state)).toBe(false);
    work.check();
    expect([store.ui.frameIndex, isInCheck(store.state)]).toEqual([3, true]);
    work.run('toggle-checked');
    expect(store.ui.frameIndex).toBe(2);
    work.run('next-unfinished');
    expect(store.ui.frameIndex).toBe(1);
    work.run('toggle-checked');
    expect(store.ui.frameIndex).toBe(2);
    expect(store.ui.notice?.text).not.toMatch(/is left/);
    work.run('toggle-checked');
    expect(store.ui.checking).toBe(false);
    expect(store.ui.notice?.text).toBe('Frame 3, femur: checked. Nothing doubtful or missing is left.');
  });
});

/** The femur was looked for in a frame and is nowhere. */
function loseIn(store: Store, frame: number) {
  const result = { kind: 'failed', origin: 'o', sentence: 'It was not found.' } as const;
  store.perform({ label: 'follow', apply: (doc) => withCell(doc, place(frame), { outline: null, result, resultOf: null }) });
}

describe('the joint of one component', () => {
  it('is not opened where nobody would see it: what it needs is said', () => {
    const { store, work } = bench([0, 0]);
    work.run('joint-curves');
    expect(store.ui.joint.open).toBe(false);
    expect(store.ui.notice?.text).toMatch(/^A joint needs both components/);
  });
});

describe('a cell without a pose', () => {
  it('stands in the queue behind what is doubtful, and leads to the check', () => {
    const { store } = bench([0, 1.1, 0]);
    loseIn(store, 2);
    expect(doubtsOf(store.doc).map(({ index }) => index)).toEqual([1, 2]);
    expect(standingOf(store.doc)).toMatchObject({ doubtful: 1, lacking: 1 });
  });

  it('is gone to by N, and said by Y to be rightly empty, which holds until something is found there', () => {
    const { store, work, press } = bench([0, 0, 0]);
    loseIn(store, 1);
    work.check();
    expect([store.ui.frameIndex, isInCheck(store.state)]).toEqual([1, true]);
    expect(press('1')).toBe(false);
    work.run('toggle-checked');
    expect([isInCheck(store.state), store.ui.checking, doubtsOf(store.doc).length]).toEqual([false, false, 0]);
    const found: Posed = { kind: 'posed', from: 'film', origin: 'o', candidates: [bare(poseOf(1))], chosen: 0, reason: null, decided: true, verdict: { word: 'doubtful', because: 'of its mirror image' }, doubt: 2 };
    store.perform({ label: 'follow', apply: (doc) => withCell(doc, place(1), { outline: null, result: found, resultOf: null }) });
    expect(doubtsOf(store.doc).map(({ index }) => index)).toEqual([1]);
  });
});

describe('keys of the check', () => {
  it('take a rival, which is then set by a person, and edit; they mean something else where nothing is doubtful', () => {
    const { store, work, chosen, press } = bench([0, 1.1]);
    expect(press('2')).toBe(false);
    work.check();
    expect(press('3')).toBe(false);
    expect(press('2')).toBe(true);
    expect(chosen).toHaveBeenCalledWith(1);
    expect(spanToFollow(store.doc, 'femur')).toBeNull();
    expect(isInCheck(store.state)).toBe(true);
    expect(press('1')).toBe(true);
    expect(cellOf(store.doc, 'f1', 'femur').result).toMatchObject({ chosen: 0 });
    expect(press('e')).toBe(true);
    expect(store.ui.tool).toBe('pose');
    expect(press('q')).toBe(false);
  });
});
