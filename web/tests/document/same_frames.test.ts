import { expect, it } from 'vitest';
import { addFrames } from '../../src/document/commands';
import { distinct, pictureOf } from '../../src/document/same_frames';
import { EMPTY_DOC } from '../../src/document/types';

it('frames that look alike are frames of their own, with one picture', () => {
  const frame = (id: string, name: string) => ({ id, name, source: 's', indexInSource: 0, width: 8, height: 8 });
  const film = distinct([frame('a:0', '1'), frame('b:0', '2'), frame('a:0', '3'), frame('a:0', '4')]);
  expect(film.map(({ id, name }) => `${id} ${name}`)).toEqual(['a:0 1', 'b:0 2', 'a:0~2 3', 'a:0~3 4']);
  expect(film.map(({ id }) => pictureOf(id))).toEqual(['a:0', 'b:0', 'a:0', 'a:0']);
  // The same folder once more adds nothing.
  const doc = addFrames(film).apply(EMPTY_DOC);
  expect(addFrames(distinct(film)).apply(doc)).toBe(doc);
});
