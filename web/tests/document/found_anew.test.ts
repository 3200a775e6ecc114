import { expect, it } from 'vitest';
import { addFrames, setCalibration, setModel } from '../../src/document/commands';
import { takeFollowed } from '../../src/document/followed';
import { droppedIn } from '../../src/document/found_anew';
import { bare } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { cellOf, type Posed } from '../../src/document/types';
import { withCell } from '../../src/document/commands';

const POSE = { x: 0, y: 0, z: -900, zRot: 0, xRot: 0, yRot: 0 };
const place = (frameId: string, component: 'femur' | 'tibia' = 'femur') => ({ frameId, component }) as const;

/** Followed in two frames, set by hand in a third. */
function work(): Store {
  const store = new Store();
  store.perform(addFrames(['a', 'b', 'c'].map((id, at) => ({ id, name: id, source: 's', indexInSource: at, width: 8, height: 8 }))));
  store.perform(setCalibration({ name: 'c', text: 'one' }));
  for (const component of ['femur', 'tibia'] as const) store.perform(setModel(component, { name: 'm', sha256: component }));
  const found = { pose: POSE, deviations: null, residual: 0.3, doubtful: false, badness: 0, rival: null, led: false, isLeader: false, because: 'it lies on edges', from: 'frame 3' };
  store.perform(takeFollowed([place('a'), place('b'), place('a', 'tibia')].map((place) => ({ ...found, place }))));
  const byHand: Posed = { kind: 'posed', from: 'hand', origin: 'by hand', candidates: [bare(POSE)], chosen: 0, reason: null, decided: true, verdict: { word: 'good', because: 'it fits' } };
  store.perform({ label: 'by hand', apply: (doc) => withCell(doc, place('c'), { outline: null, result: byHand, resultOf: null }) });
  return store;
}

/** The verdict, or what there is instead. */
function states(store: Store): readonly string[] {
  return (['a', 'b', 'c'] as const).flatMap((id) =>
    (['femur', 'tibia'] as const).map((component) => {
      const { result } = cellOf(store.doc, id, component);
      return result === null ? 'empty' : result.kind === 'posed' ? (result.verdict?.word ?? 'not judged') : 'failed';
    }),
  );
}

const WHOLE = ['good', 'good', 'good', 'empty', 'good', 'empty'];

it('what was followed with another model is dropped, and what somebody set is judged anew', () => {
  const store = work();
  expect(states(store)).toEqual(WHOLE);
  const before = store.doc;
  store.perform(setModel('femur', { name: 'larger', sha256: 'larger' }));
  expect(states(store)).toEqual(['empty', 'good', 'empty', 'empty', 'not judged', 'empty']);
  expect(droppedIn(before, store.doc)).toBe(2);
  store.undo();
  expect(states(store)).toEqual(WHOLE);
});

it('so it is of both components with another calibration, and the same one changes nothing', () => {
  const store = work();
  store.perform(setCalibration({ name: 'again', text: 'one' }));
  expect(states(store)).toEqual(WHOLE);
  const before = store.doc;
  store.perform(setCalibration({ name: 'other', text: 'two' }));
  expect(states(store)).toEqual(['empty', 'empty', 'empty', 'empty', 'not judged', 'empty']);
  expect(droppedIn(before, store.doc)).toBe(3);
  store.undo();
  store.perform(setCalibration(null));
  expect(states(store)[0]).toBe('empty');
});
