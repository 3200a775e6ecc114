import { describe, expect, it } from 'vitest';
import { addPoint, closeOutline, deletePoint, insertPoint, movePoint, setWindow, withCell } from '../../src/document/commands';
import * as history from '../../src/document/history';
import { cellOf, EMPTY_DOC, type Outline, type Result } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';

const place = { frameId: 'f', component: 'femur' } as const;
const outlineIn = (h: history.History): Outline | null => cellOf(h.present, 'f', 'femur').outline;
const at = (column: number, row = 0) => framePoint(column, row);

function traced(...columns: number[]): history.History {
  return columns.reduce((h, column) => history.perform(h, addPoint(place, at(column))), history.startHistory(EMPTY_DOC));
}

describe('history', () => {
  it('takes back and gives again point by point', () => {
    let h = traced(1, 2, 3);
    h = history.perform(h, closeOutline(place));
    expect(outlineIn(h)).toMatchObject({ closed: true });
    h = history.undo(history.undo(h));
    expect(outlineIn(h)?.points.map((p) => p.column)).toEqual([1, 2]);
    h = history.redo(history.redo(h));
    expect(outlineIn(h)).toMatchObject({ closed: true });
    expect(history.redo(h)).toBe(h);
  });

  it('makes one unit of a gesture, however often it was previewed', () => {
    let h = traced(1, 2, 3);
    const before = h.past.length;
    for (const column of [5, 6, 7]) h = history.preview(h, movePoint(place, 1, at(column)));
    h = history.commitPreview(h, movePoint(place, 1, at(7)));
    expect(h.past.length).toBe(before + 1);
    expect(outlineIn(h)?.points[1]?.column).toBe(7);
    expect(outlineIn(history.undo(h))?.points[1]?.column).toBe(2);
  });

  it('previews an insertion from the document before the gesture, not on top of itself', () => {
    let h = traced(1, 3);
    h = history.preview(h, insertPoint(place, 1, at(2)));
    h = history.preview(h, insertPoint(place, 1, at(2.5)));
    expect(outlineIn(h)?.points.map((p) => p.column)).toEqual([1, 2.5, 3]);
    expect(outlineIn(history.cancelPreview(h))?.points.length).toBe(2);
  });

  it('goes back into some works and holds no others, and within one as far as before', () => {
    const turn = (h: history.History, work: string) => history.perform(h, { label: work, apply: () => ({ ...EMPTY_DOC, work }) });
    let h = history.startHistory({ ...EMPTY_DOC, work: '0' });
    for (let work = 1; work <= 20; work++) {
      h = turn(h, '');
      h = history.amend(h, (doc) => ({ ...doc, work: String(work) }));
      for (const column of [1, 2, 3]) h = history.perform(h, addPoint(place, at(column)));
    }
    const worksOf = (steps: history.History['past']) => [...new Set(steps.map(({ doc }) => doc.work))];
    expect(worksOf(h.past)).toEqual(['17', '18', '19', '20']);
    for (let step = 0; step < 200; step++) h = history.perform(h, addPoint(place, at(step)));
    expect(h.past.filter(({ doc }) => doc.work === '20')).toHaveLength(203);
    while (history.nextUndo(h)) h = history.undo(h);
    expect([h.present.work, outlineIn(h)]).toEqual(['17', null]);
    // What is there again is not lost by the way forth.
    while (history.nextRedo(h)) h = history.redo(h);
    expect([h.present.work, outlineIn(h)?.points.length]).toEqual(['20', 203]);
  });

  it('drops the future after a new command', () => {
    const h = history.perform(history.undo(traced(1, 2)), addPoint(place, at(9)));
    expect(history.nextRedo(h)).toBeNull();
  });

  it('undo and redo keep what was found meanwhile, in other cells and in ones that come back', () => {
    const found: Result = { kind: 'failed', origin: 'k', sentence: 's' };
    const better: Result = { ...found, sentence: 't' };
    const elsewhere = { frameId: 'g', component: 'tibia' } as const;
    const amended = (h: history.History, at: typeof place | typeof elsewhere, result: Result) =>
      history.amend(h, (doc) => withCell(doc, at, { ...cellOf(doc, at.frameId, at.component), result }));
    const frames = ['f', 'g'].map((id) => ({ id, name: id, source: id, indexInSource: 0, width: 8, height: 8 }));
    let h = history.startHistory({ ...EMPTY_DOC, frames });
    for (const column of [1, 2, 3]) h = history.perform(h, addPoint(place, at(column)));
    h = history.perform(h, closeOutline(place));
    h = amended(h, place, found);
    h = history.perform(h, setWindow({ centre: 1, width: 1 }));
    h = amended(amended(h, place, better), elsewhere, found);
    h = history.undo(h);
    expect(h.present.window).toBeNull();
    expect([cellOf(h.present, 'f', 'femur').result, cellOf(h.present, 'g', 'tibia').result]).toEqual([better, found]);
    h = history.redo(history.undo(history.undo(h)));
    // Two points of a draft never had a result; what is elsewhere has nothing to do with them.
    expect([outlineIn(h)?.closed, cellOf(h.present, 'f', 'femur').result, cellOf(h.present, 'g', 'tibia').result]).toEqual([false, null, found]);
    expect(cellOf(history.redo(h).present, 'f', 'femur').result).toEqual(better);
  });

  it('what a person took back stays taken back', () => {
    const found: Result = { kind: 'failed', origin: 'k', sentence: 's' };
    let h = history.perform(traced(1, 2, 3), closeOutline(place));
    const undone = history.undo(h);
    h = history.amend(history.redo(undone), (doc) => withCell(doc, place, { ...cellOf(doc, 'f', 'femur'), result: found }));
    expect(cellOf(history.undo(h).present, 'f', 'femur').result).toBeNull();
    expect(history.undo(history.undo(h)).present).toBe(history.undo(undone).present);
  });

  it('merges commands with the same key, and only those that follow each other', () => {
    let h = history.perform(history.startHistory(EMPTY_DOC), setWindow({ centre: 1, width: 2 }));
    h = history.perform(h, setWindow({ centre: 3, width: 4 }));
    expect(h.past.length).toBe(1);
    h = history.perform(h, addPoint(place, at(1)));
    h = history.perform(h, setWindow(null));
    expect(h.past.length).toBe(3);
  });

  it('counts what the machine adds neither as undo unit nor as unsaved work', () => {
    const result: Result = { kind: 'failed', origin: 'k', sentence: 's' };
    let h = traced(1);
    h = history.markSaved(h, h.present);
    const steps = h.past.length;
    h = history.amend(h, (doc) => withCell(doc, place, { ...cellOf(doc, 'f', 'femur'), result }));
    expect(h.past.length).toBe(steps);
    expect(history.hasUnsavedWork(h)).toBe(false);
    expect(history.hasUnsavedWork(history.perform(h, addPoint(place, at(2))))).toBe(true);
  });

  it('keeps the latest result on view while a closed outline is dragged', () => {
    let h = history.perform(traced(1, 2, 3), closeOutline(place));
    const result: Result = { kind: 'failed', origin: 'k', sentence: 'first' };
    h = history.preview(h, movePoint(place, 0, at(0)));
    h = history.amend(h, (doc) => withCell(doc, place, { ...cellOf(doc, 'f', 'femur'), result }));
    h = history.preview(h, movePoint(place, 0, at(-1)));
    expect(cellOf(h.present, 'f', 'femur').result).toBe(result);
  });

  it('keeps a result for another cell that arrives during a gesture', () => {
    const other = { frameId: 'g', component: 'tibia' } as const;
    const result: Result = { kind: 'failed', origin: 'k', sentence: 's' };
    let h = history.preview(traced(1, 2), movePoint(place, 0, at(5)));
    h = history.amend(h, (doc) => withCell(doc, other, { ...cellOf(doc, 'g', 'tibia'), result }));
    h = history.commitPreview(history.preview(h, movePoint(place, 0, at(6))), movePoint(place, 0, at(6)));
    expect(cellOf(h.present, 'g', 'tibia').result).toBe(result);
  });

  it('deletes the outline with its last point', () => {
    const h = history.perform(traced(1), deletePoint(place, 0));
    expect(outlineIn(h)).toBeNull();
  });
});
