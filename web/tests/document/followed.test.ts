import { expect, it } from 'vitest';
import { addFrames } from '../../src/document/commands';
import { unjudged, withoutSoFar, withSoFar } from '../../src/document/followed';
import { Store } from '../../src/document/store';

it('frames that are followed so far are not judged, until the film is', () => {
  const store = new Store();
  store.perform(addFrames(['a', 'b', 'c'].map((id, at) => ({ id, name: id, source: 's', indexInSource: at, width: 8, height: 8 }))));
  const pose = { x: 0, y: 0, z: -900, zRot: 0, xRot: 0, yRot: 0 };
  const place = (frameId: string) => ({ frameId, component: 'femur' }) as const;
  for (const id of ['a', 'c']) store.amend((doc) => withSoFar(doc, place(id), pose, 'frame 2'));
  expect([unjudged(store.doc, 'femur'), unjudged(store.doc, 'tibia')]).toEqual([2, 0]);
  store.amend((doc) => withoutSoFar(doc, [[place('a'), null]]));
  expect(unjudged(store.doc, 'femur')).toBe(1);
});
