import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { addFrames, addPoint, closeOutline, movePoint, setCalibration, setLibraryFile, setModel } from '../../src/document/commands';
import { setDistortion } from '../../src/document/set_distortion';
import type { Distortion } from '../../src/document/distortion';
import type { Place } from '../../src/document/command';
import { bare, setPoseByHand } from '../../src/document/hand_poses';
import { startEmpty } from '../../src/document/start_anew';
import { Store } from '../../src/document/store';
import { cellOf, chosenCandidate, isByHand, verdictOf } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import type { PoseNumbers } from '../../src/geometry/pose_numbers';
import { FromHere } from '../../src/jobs/from_here';
import { HAND_REST, HandJudge } from '../../src/jobs/hand_judge';
import { Librarian } from '../../src/jobs/librarian';
import { Poser, REST } from '../../src/jobs/poser';
import { NO_MARK } from '../../src/document/marks';
import { progressOf } from '../../src/results/progress';
import { poseKey } from '../../src/results/keys';
import { OneClick } from '../../src/tracing/one_click';
import { keepLibraryOpen } from './open_library';

const PLACE: Place = { frameId: 'f', component: 'femur' };
const FRAME = { id: 'f', name: 'f', source: 's', indexInSource: 0, width: 100, height: 100 };
const poseOf = (x: number): PoseNumbers => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });

function begun(): Store {
  const store = new Store();
  store.perform(addFrames([FRAME]));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
  return store;
}

function trace(store: Store): void {
  for (const [column, row] of [[10, 10], [50, 10], [30, 60]] as const) store.perform(addPoint(PLACE, framePoint(column, row)));
  store.perform(closeOutline(PLACE));
}

const studio = { framePixels: async () => ({ pixels: new Uint8Array(4), width: 2, height: 2, covered: new Uint32Array() }), meshOf: () => null, suspectedUnitsOf: () => [] };

/** A worker that answers when the test says so. */
function held() {
  const asked: { method: string; input: any; answer: (value: unknown) => Promise<void> }[] = [];
  const call = (method: string, input: unknown) =>
    new Promise((resolve) => asked.push({ method, input, answer: async (value) => (resolve(value), void (await vi.advanceTimersByTimeAsync(1))) }));
  return { asked, worker: { call } as never };
}

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe('refining from here', () => {
  it('does not call a pose good against an outline that was changed while it was refined', async () => {
    const store = begun();
    keepLibraryOpen(store, 'femur');
    trace(store);
    store.perform(setPoseByHand(PLACE, poseOf(1)));
    const { asked, worker } = held();
    const here = new FromHere({ store, studio } as never, worker, { ready: async () => undefined });
    const done = here.refine(PLACE);
    await vi.advanceTimersByTimeAsync(1);
    expect(asked[0]?.method).toBe('refineFrom');
    // The pose by hand stays; the outline is another one by now.
    store.perform(movePoint(PLACE, 2, framePoint(90, 90)));
    await asked[0]!.answer({ pose: poseOf(2), residual: 0.1, drawn: 1, deviations: null, bright: false, verdict: { word: 'good', because: 'the outline is met' } });
    await done;
    const { outline, result, resultOf } = cellOf(store.doc, 'f', 'femur');
    const isSaidOfThisOutline = result?.kind === 'posed' && result.verdict?.word === 'good' && resultOf === outline;
    expect({ isSaidOfThisOutline, says: verdictOf(result) }).toEqual({ isSaidOfThisOutline: false, says: expect.not.objectContaining({ word: 'good' }) });
  });
});

describe('the judge of poses by hand', () => {
  it('takes no verdict that was found with another calibration, and asks again', async () => {
    const store = begun();
    keepLibraryOpen(store, 'femur');
    const { asked, worker } = held();
    new HandJudge({ store, studio } as never, worker);
    store.perform(setPoseByHand(PLACE, poseOf(1)));
    await vi.advanceTimersByTimeAsync(HAND_REST + 1);
    expect(asked.map(({ input }) => input.camera.text)).toEqual(['c']);
    store.perform(setCalibration({ name: 'another', text: 'another' }));
    await asked[0]!.answer({ word: 'good', because: 'by the calibration before' });
    await vi.advanceTimersByTimeAsync(10 * HAND_REST);
    expect(verdictOf(cellOf(store.doc, 'f', 'femur').result)?.because).not.toBe('by the calibration before');
    expect(asked.at(-1)!.input.camera.text).toBe('another');
  });

  it('asks again once the frame can be held against the pose: the correction that prevented it is taken away', async () => {
    const store = begun();
    keepLibraryOpen(store, 'femur');
    const zeros = Array.from({ length: 21 }, () => 0);
    const quality = { beads: 9, dropped: 0, before: 1, after: 0.1, leftOut: [], largestShift: 1 };
    const distortion: Distortion = { name: 'd', appliesTo: 'outlines', order: 3, width: 100, height: 100, centre: [50, 50], scale: 50, column: zeros, row: zeros, quality };
    store.perform(setDistortion(distortion, null, null));
    const { asked, worker } = held();
    new HandJudge({ store, studio } as never, worker);
    store.perform(setPoseByHand(PLACE, poseOf(1)));
    await vi.advanceTimersByTimeAsync(10 * HAND_REST);
    expect(asked).toEqual([]);
    store.perform(setDistortion(null, null, null));
    await vi.advanceTimersByTimeAsync(10 * HAND_REST);
    expect(asked.map(({ method }) => method)).toEqual(['judgeOnFrame']);
  });
});

describe('a click whose answer comes late', () => {
  const answer = () => ({
    outlines: [Float64Array.of(1, 1, 5, 1, 5, 5)],
    supports: [],
    corrected: false,
    bright: false,
    sentence: 'Found.',
    match: { candidates: [bare(poseOf(99))], reason: 'r', decided: true, refusal: null, verdict: { word: 'good', because: 'b' } },
  });

  async function clicked() {
    const store = begun();
    keepLibraryOpen(store, 'femur');
    const { asked, worker } = held();
    const oneClick = new OneClick({ store, studio } as never, worker, { ready: async () => undefined });
    void oneClick.ask([framePoint(1, 1)], PLACE, false);
    await vi.advanceTimersByTimeAsync(1);
    expect(asked).toHaveLength(1);
    return { store, asked };
  }

  it('leaves a pose that a hand has set meanwhile', async () => {
    const { store, asked } = await clicked();
    store.perform(setPoseByHand(PLACE, poseOf(7)));
    await asked[0]!.answer(answer());
    const { result } = cellOf(store.doc, 'f', 'femur');
    expect([isByHand(result), chosenCandidate(cellOf(store.doc, 'f', 'femur'))?.pose.x]).toEqual([true, 7]);
  });

  it('leaves nothing in another work that was begun meanwhile', async () => {
    const { store, asked } = await clicked();
    startEmpty(store);
    const before = store.doc;
    const units = store.state.history.past.length;
    await asked[0]!.answer(answer());
    expect(store.doc.cells.isEmpty).toBe(true);
    expect(store.doc).toBe(before);
    expect(store.state.history.past.length).toBe(units);
  });
});

describe('the poser beside the librarian', () => {
  /** As `main.tsx` puts them together: the poser hears of a change before the librarian. */
  function page() {
    const store = begun();
    const asked: { library: string | null; answer: () => Promise<void> }[] = [];
    /** What the worker has open: it answers from that. */
    let open: string | null = null;
    const call = (method: string) =>
      new Promise((resolve) => {
        const library = open;
        const pose = poseOf(library === 'B' ? 2 : 1);
        const candidates = [{ pose, unmatched: 5, drawn: 6, residual: null, deviations: null, judged: null, start: null, atBorder: false, picture: null }];
        const match = { candidates, canonicalSize: 1, canonicalArea: 1, clipped: false, partial: false, reason: null, decided: false, verdict: null, refusal: null, milliseconds: 1 };
        asked.push({ library: `${method} in ${library}`, answer: async () => (resolve(match), void (await vi.advanceTimersByTimeAsync(1))) });
      });
    const poser = new Poser(store, { call } as never);
    vi.stubGlobal('navigator', { hardwareConcurrency: 2 });
    let ready: () => void = () => undefined;
    const opens = { call: () => new Promise((resolve) => (ready = () => resolve({ views: 1, bytes: 1 }))) };
    new Librarian({ store, studio: { meshOf: () => ({}) }, assets: { get: () => ({ blob: new Blob(['l']) }) } } as never, opens as never);
    const opened = async (name: string) => {
      await vi.advanceTimersByTimeAsync(1);
      open = name;
      await vi.waitFor(() => (ready(), expect(store.ui.libraries.femur.state).toBe('ready')));
    };
    return { store, poser, asked, opened };
  }

  it('asks nothing of a library that the document has replaced', async () => {
    const { store, asked, opened } = page();
    store.perform(setLibraryFile('femur', { name: 'A', sha256: 'A' }));
    await opened('A');
    trace(store);
    await vi.advanceTimersByTimeAsync(REST);
    for (let k = 0; k < 4 && asked.length > k; k++) {
      await asked[k]!.answer();
      await vi.advanceTimersByTimeAsync(REST);
    }
    const before = asked.length;
    store.perform(setLibraryFile('femur', { name: 'B', sha256: 'B' }));
    await vi.advanceTimersByTimeAsync(1);
    // Library B is not open yet: nobody can be asked.
    expect(asked.slice(before).map(({ library }) => library)).toEqual([]);
  });

  it('has no pose of the library before under the key of the new one', async () => {
    const { store, asked, opened } = page();
    store.perform(setLibraryFile('femur', { name: 'A', sha256: 'A' }));
    await opened('A');
    trace(store);
    const answerAll = async () => {
      for (let k = 0; k < 40; k++) {
        const next = asked.find((one) => !(one as any).done);
        if (next) ((next as any).done = true), await next.answer();
        await vi.advanceTimersByTimeAsync(REST);
      }
    };
    await answerAll();
    store.perform(setLibraryFile('femur', { name: 'B', sha256: 'B' }));
    await answerAll();
    await opened('B');
    await answerAll();
    const { result } = cellOf(store.doc, 'f', 'femur');
    expect(result?.origin).toBe(poseKey(store.doc, 'femur', FRAME));
    // A answers 1, B answers 2.
    expect(chosenCandidate(cellOf(store.doc, 'f', 'femur'))?.pose.x).toBe(2);
  });

  it('shows no pose of the model before as one of the new model, while its library is built', async () => {
    const { store, asked, opened } = page();
    // The library comes as a file, then the model is replaced and its library has to be built.
    store.perform(setLibraryFile('femur', { name: 'A', sha256: 'A' }));
    await opened('A');
    trace(store);
    const answerAll = async () => {
      for (let k = 0; k < 20; k++) {
        const next = asked.find((one) => !(one as any).done);
        if (next) ((next as any).done = true), await next.answer();
        await vi.advanceTimersByTimeAsync(REST);
      }
    };
    await answerAll();
    store.perform({ label: 'another model, and its own library', apply: (doc) => setLibraryFile('femur', null).apply(setModel('femur', { name: 'm2', sha256: 'm2' }).apply(doc)) });
    await answerAll();
    const cell = cellOf(store.doc, 'f', 'femur');
    const { outdated } = progressOf(cell, NO_MARK, poseKey(store.doc, 'femur', FRAME));
    // A pose of A may be shown as outdated, or none; not as one of m2, whose library nobody has yet.
    expect({ library: store.ui.libraries.femur.state === 'ready', isOfA: chosenCandidate(cell)?.pose.x === 1, outdated }).toEqual({ library: false, isOfA: true, outdated: true });
  });
});
