import { expect, it } from 'vitest';
import { addFrames, addPoint } from '../../src/document/commands';
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
  expect(said()).toBeNull();
  store.perform(addPoint(place('a'), framePoint(1, 1)));
  expect(said()).toBe(texts.follow.gaveWay);
  store.quiet();
  store.perform(addPoint(place('a'), framePoint(5, 1)));
  expect(said()).toBeNull();
  store.undo();
  store.undo();
  expect(cellOf(store.doc, 'a', 'femur').result?.kind).toBe('posed');
});
