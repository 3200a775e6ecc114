import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import {
  addFrames,
  addPoint,
  carryResult,
  closeOutline,
  deleteOutline,
  loadPoses,
  movePoint,
  setCalibration,
  setModel,
  withCell,
} from '../../src/document/commands';
import { withAxes } from '../../src/document/axes';
import type { Place } from '../../src/document/command';
import { bare, dropHandPose, isPicked, offerCandidate, setPoseByHand, takeHandFit } from '../../src/document/hand_poses';
import { forgetReference, keepReference, referencePose } from '../../src/document/reference';
import { DEFAULT_HAND, DEFAULT_SEEING } from '../../src/terms/seeing';
import { readTaste, writeTaste } from '../../src/keep/taste_text';
import { readSession, writeSession } from '../../src/document/session/session';
import { Store } from '../../src/document/store';
import { poseTable } from '../../src/document/session/table';
import { type Axes, cellOf, chosenCandidate, isByHand, type Posed } from '../../src/document/types';
import { NO_LOCKS, type PoseNumbers } from '../../src/geometry/pose_numbers';
import { FromHere } from '../../src/jobs/from_here';
import { Poser } from '../../src/jobs/poser';
import type { Services } from '../../src/jobs/services';
import { aroundHand, surroundingsOf } from '../../src/results/surroundings';
import { framePoint } from '../../src/geometry/points';
import { rememberTaste } from '../../src/keep/taste';
import { keepLibraryOpen } from '../jobs/open_library';

const OWN_AXES: Axes = { directions: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], from: 'shape', told: 'all' };
const PLACE: Place = { frameId: 'f', component: 'femur' };
const POSE: PoseNumbers = { x: 1, y: 2, z: -1000, zRot: 3, xRot: 4, yRot: 5 };
const OTHER: PoseNumbers = { ...POSE, x: 9 };

const cell = (store: Store) => cellOf(store.doc, 'f', 'femur');
const shown = (store: Store) => chosenCandidate(cell(store))?.pose ?? null;

function traced(): Store {
  const store = new Store();
  store.perform(addFrames([{ id: 'f', name: 'f', source: 's', indexInSource: 0, width: 100, height: 100 }]));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
  keepLibraryOpen(store, 'femur');
  for (const [column, row] of [[10, 10], [50, 10], [30, 60]] as const) store.perform(addPoint(PLACE, framePoint(column, row)));
  store.perform(closeOutline(PLACE));
  return store;
}

describe('a pose set by hand', () => {
  it('is undone and redone like everything else, a held key as one step', () => {
    const store = traced();
    for (let x = 0; x < 5; x++) store.perform(setPoseByHand(PLACE, { ...POSE, x }, 'adjust the pose', 'nudge-1'));
    store.perform(setPoseByHand(PLACE, OTHER, 'adjust the pose', 'nudge-2'));
    store.undo();
    expect(shown(store)?.x).toBe(4);
    store.undo();
    expect(shown(store)).toBeNull();
    store.redo();
    store.redo();
    expect(shown(store)).toEqual(OTHER);
  });

  it('is held against what had been found there, also when it is moved and refined again', () => {
    const store = traced();
    const found: Posed = { kind: 'posed', from: 'outline', origin: 'o', candidates: [bare(POSE), bare(OTHER)], chosen: 0, reason: null, decided: true, verdict: null };
    store.amend((doc) => withCell(doc, PLACE, { ...cell(store), result: found, resultOf: cell(store).outline }));
    expect(aroundHand(store.doc, PLACE).rivals).toEqual([POSE, OTHER]);
    store.perform(setPoseByHand(PLACE, { ...POSE, xRot: 20 }));
    const verdict = { word: 'good', because: 'b' } as const;
    store.perform(takeHandFit(PLACE, { candidate: bare({ ...POSE, xRot: 21 }), reason: 'r', verdict, onFrame: { film: null } }));
    store.perform(setPoseByHand(PLACE, { ...POSE, xRot: 22 }));
    expect(aroundHand(store.doc, PLACE).rivals).toEqual([POSE, OTHER]);
    const view = { frameIndex: 0, component: 'femur', overlayOpacity: 0.5 } as const;
    const text = writeSession({ doc: store.doc, view, files: [], audit: null }, 'test', new Date(0)).join('');
    expect(aroundHand(readSession(text).doc, PLACE).rivals).toEqual([POSE, OTHER]);
    store.undo();
    store.undo();
    store.undo();
    expect(cell(store).result).toBe(found);
  });

  it('outlives changes of the outline, and its deletion', () => {
    const store = traced();
    store.perform(setPoseByHand(PLACE, POSE));
    store.perform(movePoint(PLACE, 0, framePoint(12, 12)));
    store.perform(deleteOutline(PLACE));
    expect(shown(store)).toEqual(POSE);
    expect(isByHand(cell(store).result)).toBe(true);
  });

  it('is previewed though a result of the outline is on view', () => {
    const store = traced();
    const { outline } = cell(store);
    const result: Posed = { kind: 'posed', from: 'outline', origin: 'k', candidates: [bare(OTHER)], chosen: 0, reason: null, decided: true, verdict: null };
    store.amend((doc) => withCell(doc, PLACE, { outline, result, resultOf: outline }));
    store.preview(setPoseByHand(PLACE, POSE));
    expect(shown(store)).toEqual(POSE);
    store.cancelPreview();
    expect(shown(store)).toEqual(OTHER);
    const kept = carryResult(store.doc, setPoseByHand(PLACE, POSE).apply(store.doc), PLACE);
    expect(chosenCandidate(cellOf(kept, 'f', 'femur'))?.pose).toEqual(POSE);
  });

  it('may be relied on by its neighbours, and is named in the table', () => {
    const store = traced();
    store.perform(setPoseByHand(PLACE, POSE));
    for (const component of ['femur', 'tibia'] as const) store.amend((doc) => withAxes(doc, component, OWN_AXES));
    expect(surroundingsOf(store.doc, 'f', 'tibia').counterpart?.pose).toEqual(POSE);
    expect(poseTable(store.doc, 'femur')).toContain(',by hand,');
    store.perform(takeHandFit(PLACE, { candidate: { ...bare(OTHER), residual: 0.2 }, reason: 'Refined.', verdict: { word: 'good', because: 'it fits' }, onFrame: null }));
    expect(poseTable(store.doc, 'femur')).toContain(',good,it fits,"by hand, refined",1,1,Refined.');
  });
});

describe('a session', () => {
  it('keeps what was set by hand and the set to compare with', () => {
    const store = traced();
    store.perform(setPoseByHand(PLACE, POSE));
    store.perform(keepReference('before'));
    store.perform(setPoseByHand(PLACE, OTHER));
    const view = { frameIndex: 0, component: 'femur', overlayOpacity: 0.5 } as const;
    const text = writeSession({ doc: store.doc, view, files: [], audit: null }, 'test', new Date(0)).join('');
    const { doc } = readSession(text);
    expect(cellOf(doc, 'f', 'femur').result).toEqual(cell(store).result);
    expect(doc.reference).toEqual({ name: 'before', poses: { 'f/femur': POSE } });
    expect(readSession(text.replace(/"reference":.*?}},/, '').replace(/"checksum":\d+,/, '')).doc.reference).toBeNull();
  });
});

describe('what the page works out', () => {
  beforeEach(() => void vi.useFakeTimers());
  afterEach(() => void vi.useRealTimers());

  it('never takes the place of a pose set by hand, and does so again when that is dropped', async () => {
    const store = traced();
    const asked: string[] = [];
    const match = { candidates: [{ ...bare(OTHER), start: null, atBorder: false, picture: null }], canonicalSize: 1, canonicalArea: 1, clipped: false, partial: false, reason: null, decided: false, verdict: null, refusal: null, milliseconds: 1 };
    let answer: () => void = () => undefined;
    const call = (method: string) => (asked.push(method), new Promise((resolve) => (answer = () => resolve(match))));
    new Poser(store, { call } as unknown as ConstructorParameters<typeof Poser>[1]);
    // A match is on its way when the hand sets the pose.
    store.show({});
    expect(asked).toEqual(['match']);
    store.perform(setPoseByHand(PLACE, POSE));
    answer();
    await vi.advanceTimersByTimeAsync(1000);
    store.perform(movePoint(PLACE, 0, framePoint(15, 15)));
    await vi.advanceTimersByTimeAsync(1000);
    expect(shown(store)).toEqual(POSE);
    expect(asked).toEqual(['match']);
    store.perform(dropHandPose(PLACE));
    answer();
    await vi.advanceTimersByTimeAsync(10);
    expect(asked.length).toBeGreaterThan(1);
    answer();
    await vi.advanceTimersByTimeAsync(10);
    expect(shown(store)).toEqual(OTHER);
  });
});

describe('refining from here', () => {
  const FIT = { pose: OTHER, residual: 0.25, drawn: 12, deviations: null, bright: false };

  function bench() {
    const store = traced();
    const asked: { method: string; input: Record<string, unknown> }[] = [];
    const waited: string[] = [];
    let answer: (fit: unknown) => void = () => undefined;
    const call = (method: string, input: Record<string, unknown>) => (asked.push({ method, input }), new Promise((resolve) => (answer = resolve)));
    const studio = { framePixels: () => ({ pixels: new Uint8Array(4), width: 100, height: 100, covered: new Uint32Array() }) };
    const fromHere = new FromHere({ store, studio } as unknown as Services, { call } as unknown as ConstructorParameters<typeof FromHere>[1], { ready: async () => void waited.push('film') });
    return { store, asked, waited, fromHere, answer: () => answer(FIT) };
  }

  it('goes onto the outline, holds what is locked and can be undone', async () => {
    const { store, asked, fromHere, answer } = bench();
    store.perform(setPoseByHand(PLACE, POSE));
    store.setHand({ locks: { ...NO_LOCKS, z: true, yRot: true } });
    const done = fromHere.refine(PLACE);
    expect(asked[0]).toMatchObject({ method: 'refineFrom', input: { start: POSE, locked: [false, false, true, false, false, true] } });
    answer();
    await done;
    expect(shown(store)).toEqual(OTHER);
    expect(cell(store).result).toMatchObject({ from: 'hand', reason: expect.stringMatching(/against the outline: 0\.25 px\. Held: z and y rotation\.$/) });
    store.undo();
    expect(shown(store)).toEqual(POSE);
  });

  it('goes onto the frame where there is no outline', async () => {
    const { store, asked, waited, fromHere, answer } = bench();
    store.perform(deleteOutline(PLACE));
    store.perform(setPoseByHand(PLACE, POSE));
    // Beside the implant nobody can see whether metal is dark: it was told before.
    store.setTracing({ bright: false });
    const done = fromHere.refine(PLACE);
    await vi.waitFor(() => expect(asked.length).toBe(1));
    expect(waited).toEqual(['film']);
    expect(asked[0]).toMatchObject({ method: 'refineOnFrame', input: { start: POSE, bright: false, others: [], frame: { width: 100, height: 100 } } });
    answer();
    await done;
    expect(cell(store).result).toMatchObject({ reason: expect.stringContaining('dark edges of the frame') });
  });

  it('drops an answer for a pose that was changed meanwhile', async () => {
    const { store, fromHere, answer } = bench();
    store.perform(setPoseByHand(PLACE, POSE));
    const done = fromHere.refine(PLACE);
    store.perform(setPoseByHand(PLACE, { ...POSE, y: 7 }));
    answer();
    await done;
    expect(shown(store)?.y).toBe(7);
    expect(store.ui.notice?.text).toContain('was changed while');
  });
});

describe('another set of poses', () => {
  it('comes with a file, stays when the poses change, and is replaced by keeping', () => {
    const store = traced();
    store.perform(loadPoses('femur', [POSE], 'a.jts'));
    store.perform(setPoseByHand(PLACE, OTHER));
    expect(referencePose(store.doc, PLACE)).toEqual(POSE);
    expect(store.doc.reference?.name).toBe('a.jts');
    store.perform(keepReference('mine'));
    expect(referencePose(store.doc, PLACE)).toEqual(OTHER);
    store.perform(forgetReference());
    expect(referencePose(store.doc, PLACE)).toBeNull();
    store.undo();
    store.undo();
    expect(referencePose(store.doc, PLACE)).toEqual(POSE);
  });
});

describe('a view of the landscape', () => {
  it('becomes one more candidate, and another view takes its place', () => {
    const store = traced();
    const { outline } = cell(store);
    const best = { ...bare(POSE), drawn: 20, residual: 0.3 };
    const result: Posed = { kind: 'posed', from: 'outline', origin: 'k', candidates: [best], chosen: 0, reason: 'Only.', decided: true, verdict: null };
    store.amend((doc) => withCell(doc, PLACE, { outline, result, resultOf: outline }));
    for (const x of [8, 9]) store.perform(offerCandidate(PLACE, { ...bare({ ...POSE, x }), unmatched: 400 }));
    const now = cell(store).result as Posed;
    expect(now.candidates.map(({ pose }) => pose.x)).toEqual([1, 9]);
    expect([now.chosen, isPicked(now, now.candidates[1]!), isPicked(now, best)]).toEqual([1, true, false]);
    store.undo();
    store.undo();
    expect((cell(store).result as Posed).candidates).toEqual([best]);
  });
});

describe('taste', () => {
  it('comes back, but for comparing and locks', () => {
    const seeing = { ...DEFAULT_SEEING, preprocessing: 'edges', ghosts: true, comparing: true } as const;
    const hand = { ...DEFAULT_HAND, grain: 'fine', locks: { ...NO_LOCKS, z: true } } as const;
    expect(readTaste(writeTaste({ seeing, hand }))).toEqual({ seeing: { ...seeing, comparing: false }, hand: { ...hand, locks: NO_LOCKS } });
    for (const text of [null, '', '{}', '{"seeing":1}', 'null']) expect(readTaste(text)).toBeNull();
  });

  it('is written when it changes and read by the next page; a browser that forbids it is no trouble', () => {
    const kept = new Map<string, string>();
    const storage = { getItem: (key: string) => kept.get(key) ?? null, setItem: (key: string, value: string) => void kept.set(key, value) };
    const first = new Store();
    rememberTaste(first, storage);
    first.see({ overlay: 'outline' });
    const second = new Store();
    rememberTaste(second, storage);
    expect(second.ui.seeing.overlay).toBe('outline');
    const refusing = { getItem: () => { throw new Error('no'); }, setItem: () => { throw new Error('no'); } };
    const third = new Store();
    rememberTaste(third, refusing);
    third.see({ overlay: 'shaded' });
    expect(third.ui.seeing.overlay).toBe('shaded');
  });
});
