import { describe, expect, it, vi } from 'vitest';
import { redo, undo } from '../../src/commands/undoing';
import { addFrames, rename, withCell } from '../../src/document/commands';
import { toggleFlagged } from '../../src/document/marks';
import { Store } from '../../src/document/store';

function bench() {
  const store = new Store();
  store.perform(addFrames([0, 1].map((k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }))));
  return { store, said: () => store.ui.notice?.text };
}

describe('a step back', () => {
  it('is told with its frame and component, and so is the same step forward', () => {
    const { store, said } = bench();
    store.perform(toggleFlagged({ frameId: 'f1', component: 'tibia' }));
    undo(store);
    expect(said()).toBe('Undone: flag (frame 2, tibia). Ctrl+Y does it again.');
    redo(store);
    expect(said()).toBe('Done again: flag (frame 2, tibia).');
    expect(store.ui.log.map(({ text }) => text)).toContain('Undone: flag (frame 2, tibia). Ctrl+Y does it again.');
  });

  it('of what is about no cell names no frame', () => {
    const { store, said } = bench();
    store.perform(rename('knee'));
    undo(store);
    expect(said()).toBe('Undone: rename the study. Ctrl+Y does it again.');
  });

  it('says so where there is none', () => {
    const store = new Store();
    undo(store);
    expect(store.ui.notice?.text).toBe('There is nothing to undo.');
    redo(store);
    expect(store.ui.notice?.text).toBe('There is nothing to do again.');
  });

  it('leaves the line to the hint while an outline is drawn: it counts its points', () => {
    const { store, said } = bench();
    const place = { frameId: 'f0', component: 'femur' } as const;
    const point = (column: number) => ({ column, row: 0 });
    const draw = (count: number) => store.perform({ label: 'add a point', place, apply: (doc) => withCell(doc, place, { outline: { points: Array.from({ length: count }, (_, at) => point(at)), closed: false, unknownSides: [] }, result: null, resultOf: null } as never) });
    draw(1);
    draw(2);
    undo(store);
    expect(said()).toBeUndefined();
    redo(store);
    expect(said()).toBeUndefined();
    undo(store);
    undo(store);
    expect(said()).toBe('Undone: add a point (frame 1, femur). Ctrl+Y does it again.');
  });

  it('takes a click back while it is answered', () => {
    const { store, said } = bench();
    const cancel = vi.fn();
    store.setJob({ id: 1, title: 'click', unit: '', done: 0, total: 0, startedAt: 0, cancel, at: { column: 1, row: 1 } } as never);
    undo(store);
    expect([cancel.mock.calls.length, store.doc.frames.length]).toEqual([1, 2]);
    expect(said()).toMatch(/^The click is taken back/);
  });
});
