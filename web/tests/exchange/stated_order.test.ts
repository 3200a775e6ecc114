import { describe, expect, it } from 'vitest';
import type { FrameEntry } from '../../src/document/types';
import { statedOrder } from '../../src/exchange/stated_order';

const frame = (name: string): FrameEntry => ({ id: `${name}:0`, name, source: name, indexInSource: 0, width: 8, height: 8 });
const ordered = (places: readonly (readonly [string, number | null])[]) => {
  const film = places.map(([name]) => frame(name));
  return statedOrder(film, ({ name }) => places.find(([one]) => one === name)?.[1] ?? null)?.map(({ name }) => name) ?? null;
};

describe('the order that the files of a series state', () => {
  it('is told where their names have another one', () => {
    expect(ordered([['1.2.840.1', 12], ['1.2.840.2', 3], ['1.2.840.7', 0]])).toEqual(['1.2.840.7', '1.2.840.2', '1.2.840.1']);
  });

  it.each([
    ['it is that of the names', [['a', 1], ['b', 7], ['c', 9]]],
    ['a file does not say it', [['a', 2], ['b', null], ['c', 1]]],
    ['two say the same, as those of two series or the frames of one file do', [['a', 2], ['b', 1], ['c', 1]]],
    ['there is one frame', [['a', 5]]],
  ] as const)('is not told where %s', (_, places) => {
    expect(ordered(places)).toBeNull();
  });
});
