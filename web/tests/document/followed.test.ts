import { expect, it } from 'vitest';
import { addFrames, addPoint, closeOutline, deleteOutline, movePoint } from '../../src/document/commands';
import { takeFollowed, unjudged, withoutSoFar, withSoFar } from '../../src/document/followed';
import { Store } from '../../src/document/store';
import { cellOf, EMPTY_CELL } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import { texts } from '../../src/texts/texts';

it('frames that are followed so far are not judged, until the film is', () => {
  const store = new Store();
  store.perform(addFrames(['a', 'b', 'c'].map((id, at) => ({ id, name: id, source: 's', indexInSource: at, width: 8, height: 8 }))));
  const pose = { x: 0, y: 0, z: -900, zRot: 0, xRot: 0, yRot: 0 };
  const place = (frameId: string) => ({ frameId, component: 'femur' }) as const;
  for (const id of ['a', 'c']) store.amend((doc) => withSoFar(doc, place(id), pose, 'frame 2'));
  expect([unjudged(store.doc, 'femur'), unjudged(store.doc, 'tibia')]).toEqual([2, 0]);
  store.amend((doc) => withoutSoFar(doc, [[place('a'), EMPTY_CELL]]));
  expect(unjudged(store.doc, 'femur')).toBe(1);
});

it('says where an outline takes the place of a followed pose, and undo brings that back', () => {
  const store = new Store();
  store.perform(addFrames(['a', 'b'].map((id, at) => ({ id, name: id, source: 's', indexInSource: at, width: 8, height: 8 }))));
  const pose = { x: 0, y: 0, z: -900, zRot: 0, xRot: 0, yRot: 0 };
  const place = (frameId: string) => ({ frameId, component: 'femur' }) as const;
  const found = { pose, deviations: null, residual: 0.3, doubtful: false, badness: 0, rival: null, led: false, isLeader: false, because: 'it lies on edges', from: 'frame 2' };
  store.perform(takeFollowed([{ ...found, place: place('a') }]));
  const said = () => store.ui.notice?.text ?? null;
  store.perform(addPoint(place('b'), framePoint(1, 1)));
  const kindOf = () => cellOf(store.doc, 'a', 'femur').result?.kind;
  for (const [column, row] of [[1, 1], [5, 1], [5, 5]] as const) store.perform(addPoint(place('a'), framePoint(column, row)));
  // A draft has led to nothing yet.
  expect([said(), kindOf()]).toEqual([null, 'posed']);
  store.perform(closeOutline(place('a')));
  expect(said()).toBe(texts.follow.gaveWay);
  store.quiet();
  store.perform(movePoint(place('a'), 0, framePoint(2, 1)));
  store.undo();
  store.undo();
  expect([said(), kindOf(), cellOf(store.doc, 'a', 'femur').outline?.closed]).toEqual([null, 'posed', false]);
  store.perform(deleteOutline(place('a')));
  expect([kindOf(), cellOf(store.doc, 'a', 'femur').outline]).toEqual(['posed', null]);
});

it('what is followed anew leaves a draft as it is', () => {
  const store = new Store();
  store.perform(addFrames([{ id: 'a', name: 'a', source: 's', indexInSource: 0, width: 8, height: 8 }]));
  const pose = { x: 0, y: 0, z: -900, zRot: 0, xRot: 0, yRot: 0 };
  const place = { frameId: 'a', component: 'femur' } as const;
  const found = { place, pose, deviations: null, residual: 0.3, doubtful: false, badness: 0, rival: null, led: false, isLeader: false, because: 'it lies on edges', from: 'frame 2' };
  store.perform(takeFollowed([found]));
  store.perform(addPoint(place, framePoint(1, 1)));
  const before = cellOf(store.doc, 'a', 'femur');
  store.amend((doc) => withSoFar(doc, place, pose, 'frame 2'));
  store.perform(addPoint(place, framePoint(5, 1)));
  store.amend((doc) => withoutSoFar(doc, [[place, before]]));
  const drawn = () => cellOf(store.doc, 'a', 'femur').outline?.points.length;
  expect([drawn(), cellOf(store.doc, 'a', 'femur').result]).toEqual([2, before.result]);
  store.perform(takeFollowed([{ ...found, pose: { ...pose, x: 3 } }]));
  const { result } = cellOf(store.doc, 'a', 'femur');
  expect([drawn(), result?.kind === 'posed' && result.candidates[0]?.pose.x]).toEqual([2, 3]);
  // A draft in an empty cell is a person's work.
  store.perform(addPoint({ ...place, component: 'tibia' }, framePoint(1, 1)));
  store.perform(takeFollowed([{ ...found, place: { ...place, component: 'tibia' } }]));
  expect(cellOf(store.doc, 'a', 'tibia').result).toBeNull();
});
