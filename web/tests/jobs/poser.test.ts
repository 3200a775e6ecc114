import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { addFrames, addPoint, closeOutline, movePoint, setCalibration, setModel } from '../../src/document/commands';
import type { Place } from '../../src/document/command';
import { setOutline } from '../../src/document/outlines';
import { Store } from '../../src/document/store';
import { cellOf, type Outline, type Result } from '../../src/document/types';
import { PACE, PICTURED, Poser, REST } from '../../src/jobs/poser';
import type { Match, MatchInput, Refined } from '../../src/workers/protocol/match';
import { WorkerStopped } from '../../src/workers/bridge';
import { framePoint } from '../../src/geometry/points';
import { keepLibraryOpen } from './open_library';

interface Asked {
  readonly method: string;
  readonly input: MatchInput & { readonly before?: readonly Refined[] };
  readonly answer: (match: Match) => Promise<void>;
  readonly fail: (sentence: string) => Promise<void>;
  /** The worker stops by itself. */
  readonly stop: () => Promise<void>;
}

const PLACE: Place = { frameId: 'f', component: 'femur' };

function matchOf(x: number, residual: number | null): Match {
  const pose = { x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };
  const picture = { size: 1, input: new Uint8Array(1), view: new Uint8Array(1) };
  const candidates = [{ pose, unmatched: 5, drawn: 6, residual, deviations: null, judged: null, start: null, atBorder: false, picture }];
  const choice = { reason: null, decided: false, verdict: null, refusal: null };
  return { candidates, canonicalSize: 1, canonicalArea: 1, clipped: false, partial: false, ...choice, milliseconds: 1 };
}

/** A store with a closed outline, ready for poses, and a worker that answers when the test says so. */
function bench() {
  const store = new Store();
  const asked: Asked[] = [];
  const settle = () => vi.advanceTimersByTimeAsync(0);
  const call = (method: string, input: MatchInput) =>
    new Promise<Match>((resolve, reject) => {
      asked.push({
        method,
        input,
        answer: async (match) => (resolve(match), void (await settle())),
        fail: async (sentence) => (reject(new Error(sentence)), void (await settle())),
        stop: async () => (reject(new WorkerStopped('it stopped')), void (await settle())),
      });
    });
  const poser = new Poser(store, { call } as unknown as ConstructorParameters<typeof Poser>[1]);
  store.perform(addFrames([{ id: 'f', name: 'f', source: 's', indexInSource: 0, width: 100, height: 100 }]));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
  keepLibraryOpen(store, 'femur');
  for (const [column, row] of [[10, 10], [50, 10], [30, 60]] as const) store.perform(addPoint(PLACE, framePoint(column, row)));
  store.perform(closeOutline(PLACE));
  const result = (): Result | null => cellOf(store.doc, 'f', 'femur').result;
  const shown = () => {
    const found = result();
    const candidate = found?.kind === 'posed' ? found.candidates[0] : undefined;
    return candidate && { x: candidate.pose.x, residual: candidate.residual };
  };
  const last = () => asked.at(-1) as Asked;
  const methods = () => asked.map((one) => one.method);
  return { store, poser, asked, shown, last, methods };
}

const moved = (column: number) => movePoint(PLACE, 0, framePoint(column, 10));

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe('poser', () => {
  it('tells the finder what a tool laid on edges, and that such a pose is on the frame', async () => {
    const { store, last, methods } = bench();
    const outline = { ...cellOf(store.doc, 'f', 'femur').outline!, laidBy: 'tool' } as const;
    const result = () => cellOf(store.doc, 'f', 'femur').result;
    await last().answer(matchOf(1, null));
    await vi.advanceTimersByTimeAsync(REST);
    expect(last().input.laidBy).toBeNull();
    await last().answer(matchOf(2, 0.2));
    expect(result()).not.toHaveProperty('onFrame');
    store.perform(setOutline(PLACE, 'a region', outline));
    await vi.advanceTimersByTimeAsync(PACE);
    expect(last().input.laidBy).toBe('tool');
    // Nothing is brought onto anything yet.
    await last().answer(matchOf(3, null));
    expect(result()).not.toHaveProperty('onFrame');
    await vi.advanceTimersByTimeAsync(REST);
    await last().answer(matchOf(4, 0.3));
    expect(methods()).toEqual(['match', 'refine', 'match', 'refine']);
    expect(result()).toHaveProperty('onFrame', { film: null });
  });

  it('shows the pose of the library at once and refines it when the outline is at rest', async () => {
    const { shown, last, methods } = bench();
    expect(methods()).toEqual(['match']);
    await last().answer(matchOf(1, null));
    expect(shown()).toEqual({ x: 1, residual: null });
    await vi.advanceTimersByTimeAsync(REST - 1);
    expect(methods()).toEqual(['match']);
    await vi.advanceTimersByTimeAsync(1);
    expect(methods()).toEqual(['match', 'refine']);
    await last().answer(matchOf(2, 0.2));
    expect(shown()).toEqual({ x: 2, residual: 0.2 });
    await vi.advanceTimersByTimeAsync(10 * REST);
    expect(methods()).toEqual(['match', 'refine']);
  });

  it('takes the pose away where nothing fits, keeps the outline, and looks again when that changes', async () => {
    const { store, shown, last, methods } = bench();
    const { outline } = cellOf(store.doc, 'f', 'femur');
    await last().answer(matchOf(1, null));
    await vi.advanceTimersByTimeAsync(REST);
    await last().answer({ ...matchOf(2, 4.5), refusal: 'the outline does not fit this model from any side: 4.5 px' });
    expect(shown()).toBeUndefined();
    const cell = cellOf(store.doc, 'f', 'femur');
    expect(cell.result).toMatchObject({ kind: 'failed', sentence: 'The outline does not fit this model from any side: 4.5 px' });
    expect(cell.outline).toBe(outline);
    await vi.advanceTimersByTimeAsync(10 * REST);
    expect(methods()).toEqual(['match', 'refine']);
    store.perform(moved(20));
    expect(last().input.before).toEqual([]);
    await last().answer(matchOf(3, null));
    expect(shown()).toEqual({ x: 3, residual: null });
  });

  it('asks once more where the worker stopped by itself, and not for ever', async () => {
    const { store, last, methods } = bench();
    await last().stop();
    await vi.advanceTimersByTimeAsync(PACE);
    expect(methods()).toEqual(['match', 'match']);
    expect(cellOf(store.doc, 'f', 'femur').result).toBeNull();
    await last().stop();
    expect(cellOf(store.doc, 'f', 'femur').result).toMatchObject({ kind: 'failed', sentence: 'it stopped' });
  });

  it('takes a refused pose away when the one before had fitted and followed', async () => {
    const { store, last } = bench();
    await last().answer(matchOf(1, null));
    await vi.advanceTimersByTimeAsync(REST);
    await last().answer(matchOf(2, 0.2));
    store.perform(moved(20));
    await vi.advanceTimersByTimeAsync(PACE);
    await last().answer(matchOf(3, 0.3));
    await vi.advanceTimersByTimeAsync(REST);
    await last().answer({ ...matchOf(4, 4.5), refusal: 'nothing fits' });
    expect(cellOf(store.doc, 'f', 'femur').result).toMatchObject({ kind: 'failed', sentence: 'Nothing fits' });
  });

  it('does not refine while the outline keeps changing', async () => {
    const { store, last, methods } = bench();
    await last().answer(matchOf(1, null));
    for (let step = 1; step <= 5; step++) {
      await vi.advanceTimersByTimeAsync(REST / 2);
      store.preview(moved(10 + step));
      await last().answer(matchOf(1 + step, null));
    }
    expect(new Set(methods())).toEqual(new Set(['match']));
    await vi.advanceTimersByTimeAsync(REST);
    expect(methods().at(-1)).toBe('refine');
    expect(last().input.outline[0]).toBe(15);
  });

  it('lets a refined pose follow while a point is dragged, and refines anew when it is at rest', async () => {
    const { store, poser, shown, last, methods } = bench();
    await last().answer(matchOf(1, null));
    expect(last().input.before).toEqual([]);
    await vi.advanceTimersByTimeAsync(REST);
    await last().answer(matchOf(2, 0.2));
    for (const step of [1, 2]) {
      store.preview(moved(10 + step));
      await vi.advanceTimersByTimeAsync(PACE);
      expect(last().input.before).toMatchObject([{ pose: { x: 1 + step }, residual: 0.2 }]);
      await last().answer(matchOf(2 + step, 0.2));
      expect(shown()).toEqual({ x: 2 + step, residual: 0.2 });
    }
    expect(methods()).toEqual(['match', 'refine', 'match', 'match']);
    await vi.advanceTimersByTimeAsync(REST);
    expect(methods().at(-1)).toBe('refine');
    await last().answer(matchOf(9, 0.1));
    expect(shown()).toEqual({ x: 9, residual: 0.1 });
    expect(poser.findings(cellOf(store.doc, 'f', 'femur').outline)?.tried).toBe(true);
    await vi.advanceTimersByTimeAsync(10 * REST);
    expect(methods()).toHaveLength(5);
  });

  it('lets nothing follow when the calibration changes', async () => {
    const { store, last } = bench();
    await last().answer(matchOf(1, null));
    await vi.advanceTimersByTimeAsync(REST);
    await last().answer(matchOf(2, 0.2));
    store.perform(setCalibration({ name: 'd', text: 'd' }));
    expect(last().input.before).toEqual([]);
  });

  it('drops a refinement for which there is a newer outline', async () => {
    const { store, shown, last, methods } = bench();
    await last().answer(matchOf(1, null));
    await vi.advanceTimersByTimeAsync(REST);
    store.perform(moved(20));
    await last().answer(matchOf(2, 0.2));
    expect(shown()).toEqual({ x: 1, residual: null });
    expect(methods()).toEqual(['match', 'refine', 'match']);
    await last().answer(matchOf(3, null));
    expect(shown()).toEqual({ x: 3, residual: null });
  });

  it('refines again where undo brings back an outline whose refinement was dropped', async () => {
    const { store, shown, last, methods } = bench();
    await last().answer(matchOf(1, null));
    await vi.advanceTimersByTimeAsync(REST);
    store.perform(moved(20));
    await last().answer(matchOf(2, 0.2));
    await last().answer(matchOf(3, null));
    store.undo();
    await vi.advanceTimersByTimeAsync(REST);
    expect(methods().at(-1)).toBe('refine');
    await last().answer(matchOf(2, 0.2));
    expect(shown()).toEqual({ x: 2, residual: 0.2 });
  });

  it('keeps pictures of the latest outlines alone, and asks again for those that undo brings back, once', async () => {
    const { store, poser, shown, last, methods } = bench();
    const outlines: Outline[] = [];
    const refined = async (x: number) => {
      await vi.advanceTimersByTimeAsync(PACE);
      await last().answer(matchOf(x, null));
      await vi.advanceTimersByTimeAsync(REST);
      await last().answer(matchOf(x, 0.2));
      outlines.push(cellOf(store.doc, 'f', 'femur').outline!);
    };
    await refined(0);
    for (let step = 1; step < PICTURED + 20; step++) {
      store.perform(moved(10 + step / 8));
      await refined(step);
    }
    const pictured = outlines.filter((outline) => poser.findings(outline)!.details.some(({ picture }) => picture));
    expect(pictured).toEqual(outlines.slice(-PICTURED));
    const before = methods().length;
    for (let step = 1; step < PICTURED + 20; step++) store.undo();
    await vi.advanceTimersByTimeAsync(10 * REST);
    expect(methods().slice(before)).toEqual(['refine']);
    expect(shown()).toEqual({ x: 0, residual: 0.2 });
    const { result } = cellOf(store.doc, 'f', 'femur');
    await last().answer(matchOf(0, 0.2));
    await vi.advanceTimersByTimeAsync(10 * REST);
    expect(methods().slice(before)).toEqual(['refine']);
    expect(poser.findings(outlines[0]!)?.details[0]?.picture).not.toBeUndefined();
    // What was there is what is there.
    expect(cellOf(store.doc, 'f', 'femur').result).toBe(result);
  });

  it('is no unit of undo and no unsaved work', async () => {
    const { store, shown, last } = bench();
    await last().answer(matchOf(1, null));
    store.markSaved(store.doc);
    const units = store.state.history.past.length;
    await vi.advanceTimersByTimeAsync(REST);
    await last().answer(matchOf(2, 0.2));
    expect(shown()?.residual).toBe(0.2);
    expect(store.state.history.past.length).toBe(units);
    expect(store.state.history.saved).toBe(store.doc);
  });

  it('keeps what it found when a point is let go where it was', async () => {
    const { store, shown, last, methods } = bench();
    await last().answer(matchOf(1, null));
    store.preview(moved(20));
    await last().answer(matchOf(2, null));
    await vi.advanceTimersByTimeAsync(REST);
    await last().answer(matchOf(3, 0.3));
    store.commit(moved(20));
    await vi.advanceTimersByTimeAsync(10 * REST);
    expect(methods()).toEqual(['match', 'match', 'refine']);
    expect(shown()).toEqual({ x: 3, residual: 0.3 });
  });

  it.each([
    ['fails', (one: Asked) => one.fail('too far apart'), 'too far apart'],
    ['has no model', (one: Asked) => one.answer(matchOf(1, null)), 'the library was opened without its model.'],
  ])('keeps the pose of the library where refinement %s, and tries once', async (_, end, refusal) => {
    const { store, poser, shown, last, methods } = bench();
    await last().answer(matchOf(1, null));
    await vi.advanceTimersByTimeAsync(REST);
    await end(last());
    expect(shown()).toEqual({ x: 1, residual: null });
    expect(poser.findings(cellOf(store.doc, 'f', 'femur').outline)?.refusal).toBe(refusal);
    await vi.advanceTimersByTimeAsync(10 * REST);
    expect(methods()).toEqual(['match', 'refine']);
  });

  it('finds another pose when the calibration changes, and refines that', async () => {
    const { store, shown, last, methods } = bench();
    await last().answer(matchOf(1, null));
    await vi.advanceTimersByTimeAsync(REST);
    await last().answer(matchOf(2, 0.2));
    store.perform(setCalibration({ name: 'd', text: 'd' }));
    await last().answer(matchOf(3, null));
    expect(shown()).toEqual({ x: 3, residual: null });
    await vi.advanceTimersByTimeAsync(REST);
    expect(methods()).toEqual(['match', 'refine', 'match', 'refine']);
  });
});
