import { describe, expect, it } from 'vitest';
import { rowsOfFrames } from '../../src/exchange/pose_rows';
import type { FrameEntry } from '../../src/document/types';

const frame = (name: string, source = name, indexInSource = 0): FrameEntry => ({ id: `${source}:${indexInSource}`, name, source, indexInSource, width: 8, height: 8 });
const film = (...names: string[]) => names.map((name) => frame(name));

describe('the rows of a pose file without names', () => {
  it('are those of the frames where there are as many, in whatever order the frames stand', () => {
    expect(rowsOfFrames(3, film('f0.png', 'f10.png', 'f2.png'), [])).toEqual([0, 1, 2]);
    expect(rowsOfFrames(2, [frame('a #1', 'a', 0), frame('a #2', 'a', 1)], ['b.png'])).toEqual([0, 1]);
  });

  it('stay each with its own file where files could not be read', () => {
    expect(rowsOfFrames(7, film('f0.png', 'f1.png', 'f2.png', 'f4.png', 'f6.png', 'f7.png'), ['f5.png'])).toEqual([0, 1, 2, 3, 5, 6]);
    expect(rowsOfFrames(4, film('f2.png', 'f10.png'), ['f11.png', 'f1.png'])).toEqual([1, 2]);
  });

  it.each([
    ['more', 16, film('f0.png', 'f1.png'), []],
    ['fewer', 1, film('f0.png', 'f1.png'), []],
    ['more than those that could not be read', 4, film('f0.png', 'f1.png'), ['f2.png']],
    ['frames in an order of their own', 3, film('f2.png', 'f1.png'), ['f0.png']],
    ['frames of one file beside a lost one', 3, [frame('a.dcm #1', 'a', 0), frame('a.dcm #2', 'a', 1)], ['b.dcm']],
    ['a name twice', 3, film('f0.png', 'f1.png'), ['f0.png']],
  ] as const)('are not guessed: %s', (_, rows, frames, unread) => {
    expect(rowsOfFrames(rows, frames, unread)).toBeNull();
  });
});
