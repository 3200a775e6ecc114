import { expect, it } from 'vitest';
import { addFrames, setCalibration, setModel, swapModels, withCell } from '../../src/document/commands';
import { takeFollowed } from '../../src/document/followed';
import { droppedIn } from '../../src/document/found_anew';
import { bare } from '../../src/document/hand_poses';
import { checkState, markOf, toggleChecked } from '../../src/document/marks';
import { Store } from '../../src/document/store';
import { cellOf, type Outline, type Posed } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';

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

it('what a click led to with another model is counted among what is dropped', () => {
  const store = work();
  const outline: Outline = { points: [framePoint(2, 2), framePoint(6, 2), framePoint(6, 6)], closed: true, unknownSides: [], laidBy: 'click' };
  const result: Posed = { kind: 'posed', from: 'outline', origin: 'o', candidates: [bare(POSE)], chosen: 0, reason: null, decided: true, verdict: null };
  store.perform({ label: 'click', apply: (doc) => withCell(doc, place('c'), { outline, result, resultOf: outline }) });
  const before = store.doc;
  store.perform(setModel('femur', { name: 'larger', sha256: 'larger' }));
  expect(cellOf(store.doc, 'c', 'femur')).toMatchObject({ outline: null, result: null });
  expect(droppedIn(before, store.doc)).toBe(3);
});

it('so it is of both components with another calibration, and the same one changes nothing', () => {
  const store = work();
  const same = store.doc;
  store.perform(setCalibration({ name: 'c', text: 'one' }));
  expect(store.doc).toBe(same);
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

/** From an outline, and checked. */
function traced(): Store {
  const store = work();
  const outline: Outline = { points: [framePoint(1, 1), framePoint(5, 1), framePoint(5, 5)], closed: true, unknownSides: [] };
  const result: Posed = { kind: 'posed', from: 'outline', origin: 'as it was', candidates: [bare(POSE)], chosen: 0, reason: null, decided: true, verdict: { word: 'doubtful', because: 'it may be flipped' } };
  store.perform({ label: 'trace', apply: (doc) => withCell(doc, place('c', 'tibia'), { outline, result, resultOf: outline }) });
  store.perform(toggleChecked(place('c', 'tibia')));
  return store;
}

function checkedIn(store: Store): string {
  return checkState(cellOf(store.doc, 'c', 'tibia'), markOf(store.doc, place('c', 'tibia')));
}

it('what somebody accepted is no longer, with another model or calibration, before anything is found again', () => {
  const store = traced();
  expect(checkedIn(store)).toBe('yes');
  for (const other of [setModel('tibia', { name: 'larger', sha256: 'larger' }), setCalibration({ name: 'other', text: 'two' }), swapModels()]) {
    store.perform(other);
    expect(checkedIn(store)).toBe('changed since');
    store.undo();
    expect(checkedIn(store)).toBe('yes');
  }
  store.perform(setModel('femur', { name: 'larger', sha256: 'larger' }));
  expect(checkedIn(store)).toBe('yes');
});

it('undo of another calibration brings back what was found before, not what was found with that one', () => {
  const store = traced();
  const at = place('c', 'tibia');
  const found = () => (cellOf(store.doc, at.frameId, at.component).result as Posed).candidates[0]?.pose.z;
  const finds = (z: number) =>
    store.amend((doc) => {
      const cell = cellOf(doc, at.frameId, at.component);
      return withCell(doc, at, { ...cell, result: { ...(cell.result as Posed), candidates: [bare({ ...POSE, z })] } });
    });
  finds(-901);
  store.perform(setCalibration({ name: 'other', text: 'two' }));
  finds(-1001);
  store.undo();
  expect(found()).toBe(-901);
  store.redo();
  expect(found()).toBe(-1001);
  store.undo();
  finds(-902);
  store.perform(setModel('femur', { name: 'm', sha256: 'femur' }));
  expect(found()).toBe(-902);
});
