import { describe, expect, it } from 'vitest';
import { addFrames, setCalibration, setModel, withCell } from '../../src/document/commands';
import { Store } from '../../src/document/store';
import type { Outline } from '../../src/document/types';
import { toolFor } from '../../src/exchange/session_opener';

const OUTLINE: Outline = { points: [], closed: true, unknownSides: [] };

/** Ready for a click, with an outline by whom. */
function work(laidBy?: Outline['laidBy']): Store {
  const store = new Store();
  store.perform(addFrames([{ id: 'f', name: 'f.png', source: 's', indexInSource: 0, width: 8, height: 8 }]));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  store.perform(setModel('femur', { name: 'f.stl', sha256: 'f' }));
  const outline = laidBy ? { ...OUTLINE, laidBy } : OUTLINE;
  store.amend((doc) => withCell(doc, { frameId: 'f', component: 'femur' }, { outline, result: null, resultOf: null }));
  return store;
}

describe('the tool that a session is opened with', () => {
  it('is one click where clicks are all that there is', () => {
    expect(toolFor(work('click').doc, 'trace')).toBe('one-click');
  });

  it('is the one in hand where somebody traced, took another one, or nothing can be clicked yet', () => {
    expect(toolFor(work().doc, 'trace')).toBe('trace');
    expect(toolFor(work('tool').doc, 'trace')).toBe('trace');
    expect(toolFor(work('click').doc, 'brush')).toBe('brush');
    expect(toolFor(new Store().doc, 'trace')).toBe('trace');
  });
});
