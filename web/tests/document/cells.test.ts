import { describe, expect, it } from 'vitest';
import { CellIndex, Cells } from '../../src/document/cells';

const FRAMES = 300;
const ids = Array.from({ length: FRAMES }, (_, number) => `cells ${number}`);
const full = ids.reduce<Cells<number>>((cells, id, number) => cells.with(id, 'femur', number), Cells.NONE);

describe('cells', () => {
  it('hold what was put there, and nothing else', () => {
    expect(ids.map((id) => full.at(id, 'femur'))).toEqual(ids.map((_, number) => number));
    expect([full.at(ids[0]!, 'tibia'), full.at('another', 'femur')]).toEqual([null, null]);
    expect(full.entries()).toHaveLength(FRAMES);
    expect([Cells.NONE.isEmpty, full.isEmpty]).toEqual([true, false]);
    expect(Cells.from(full.entries().map(({ frameId, component, cell }) => [`${frameId}/${component}`, cell]))).toEqual(full);
  });

  it('share all but a page with what they were made from', () => {
    const changed = full.with(ids[150]!, 'tibia', -1);
    const shared = changed.pages.filter((page, at) => page === full.pages[at]);
    expect(changed.pages.length - shared.length).toBe(1);
    expect([full.at(ids[150]!, 'tibia'), changed.at(ids[150]!, 'tibia'), changed.at(ids[150]!, 'femur')]).toEqual([null, -1, 150]);
  });

  it('tell in what they differ, both ways', () => {
    const changed = full.with(ids[3]!, 'femur', -3).with(ids[200]!, 'tibia', -200);
    const difference = { frameId: ids[3]!, component: 'femur' };
    expect(full.differences(changed)).toEqual([
      { ...difference, before: 3, after: -3 },
      { frameId: ids[200]!, component: 'tibia', before: null, after: -200 },
    ]);
    expect(changed.differences(full)[0]).toEqual({ ...difference, before: -3, after: 3 });
    expect(full.differences(full.with(ids[3]!, 'femur', 3))).toEqual([]);
    const none: Cells<number> = Cells.NONE;
    expect(none.differences(full)).toHaveLength(FRAMES);
  });

  it('changed one by one are the same where nothing changes', () => {
    expect(full.map((cell) => cell)).toBe(full);
    const doubled = full.map((cell, frameId) => (frameId === ids[7] ? 2 * cell : cell));
    expect(full.differences(doubled).map(({ after }) => after)).toEqual([14]);
  });
});

describe('an index of cells', () => {
  it('looks at what has changed and at nothing else, unless what the test depends on has', () => {
    const looked: number[] = [];
    let least = 290;
    const index = new CellIndex<number>(({ cell }) => (looked.push(cell), cell >= least));
    expect(index.in(full, 'a')).toHaveLength(10);
    expect(looked).toHaveLength(FRAMES);
    expect(index.in(full, 'a')).toHaveLength(10);
    expect(looked).toHaveLength(FRAMES);
    const changed = full.with(ids[0]!, 'femur', 1000);
    expect(index.in(changed, 'a').map(({ cell }) => cell)).toContain(1000);
    expect(looked.length - FRAMES).toBeLessThanOrEqual(64);
    least = 0;
    expect(index.in(changed, 'b')).toHaveLength(FRAMES);
  });
});
