import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { addFrames, deleteOutline, setCalibration, setModel, withCell } from '../../src/document/commands';
import type { Command } from '../../src/document/command';
import { stateFilm } from '../../src/document/film';
import { isSurpassed } from '../../src/document/laid_by';
import { setPoseByHand } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { cellOf, chosenCandidate, type Doc, NOTHING_STATED, type Outline, type Posed } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import type { Beside } from '../../src/jobs/film_beside';
import { FILM_REST, FilmReader } from '../../src/jobs/film_reader';
import { poseKey } from '../../src/results/keys';
import type { OnFrame } from '../../src/workers/protocol/by_hand';
import type { FilmFacts, FilmProtocol, SquaresState } from '../../src/workers/protocol/film';

const OUTLINE: Outline = { points: [framePoint(1, 1), framePoint(5, 1), framePoint(3, 6)], closed: true, unknownSides: [], laidBy: 'click' };
const GOOD = { word: 'good', because: 'it fits' } as const;

type Estimate = FilmProtocol['estimate']['input'];

/** Frames with their pixels; workers that answer with a curvature for each estimate, and bring poses 1 mm nearer, or to the depths given. */
function bench(curvatures: (number | null)[] = [0.026], facts: Partial<FilmFacts> = {}, depths = [-999]) {
  const store = new Store();
  const asked: Estimate[] = [];
  const corrected: string[] = [];
  /** Unknown sides that each look at a frame kept away from. */
  const hidden: (readonly number[] | null)[] = [];
  /** Where each correction began, mm. */
  const starts: number[] = [];
  /** What is found where squares are tried. */
  const squares = { side: 1, isTold: true };
  /** Of the squares that each witness was read in. */
  const sides: (number | undefined)[] = [];
  const poses = async (method: string, input: { component: string; side?: number; unknown: OnFrame['unknown']; candidates: readonly { pose: Posed['candidates'][0]['pose'] }[] }) => {
    hidden.push(input.unknown && Array.from(input.unknown.unknownSides));
    if (method === 'filmProfiles') {
      sides.push(input.side);
      return new Float32Array(128);
    }
    corrected.push(input.component);
    starts.push(input.candidates[0]!.pose.z);
    const z = depths.length > 1 ? depths.shift()! : depths[0]!;
    return input.candidates.map(({ pose }, from) => ({
      from,
      support: 0.9,
      pose: { ...pose, z },
      residual: 0.1,
      deviations: null,
      judged: { misfit: 0.1, verdict: GOOD },
      outline: Float64Array.of(2, 2, 6, 2, 4, 7),
    }));
  };
  const films = async (method: string, input: Estimate): Promise<FilmFacts | SquaresState | null> => {
    if (method === 'beginSquares') return { wanted: 2, side: 1, isTold: false };
    if (method === 'takeSquares') return { wanted: null, side: squares.side, isTold: squares.isTold };
    asked.push(input);
    const curvature = curvatures.length > 1 ? curvatures.shift() : curvatures[0];
    const numbers = curvature == null ? null : [curvature, 0.8, 0.7, 1e-8, 0, 0, 0, 0.01, 0, 0, 0, 0.01];
    return numbers && { words: 'a film', blur: 0.8, curved: 2, profiles: 96, models: { femur: numbers, tibia: numbers }, ...facts };
  };
  const studio = { framePixels: () => ({ pixels: new Uint8Array(64), width: 8, height: 8, covered: new Uint32Array() }), meshOf: () => null, hasFrame: () => true };
  const bridges = [{ call: poses }, { call: films }] as unknown as [ConstructorParameters<typeof FilmReader>[1], ConstructorParameters<typeof FilmReader>[2]];
  const reader = new FilmReader({ store, studio } as unknown as ConstructorParameters<typeof FilmReader>[0], ...bridges);
  store.perform(addFrames(['a', 'b'].map((id) => ({ id, name: id, source: id, indexInSource: 0, width: 8, height: 8 }))));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  for (const component of ['femur', 'tibia'] as const) {
    store.perform(setModel(component, { name: component, sha256: component }));
    store.setLibrary(component, { state: 'ready', key: 'k', views: 1, bytes: 1, seconds: null });
  }
  return { store, reader, asked, corrected, hidden, starts, sides, squares, z: (frameId = 'a') => chosenCandidate(cellOf(store.doc, frameId, 'femur'))?.pose.z };
}

/** A pose as a click finds it. */
function clicked(doc: Doc, frameId = 'a', part: Partial<Posed> = {}, outline = OUTLINE): Command {
  const place = { frameId, component: 'femur' } as const;
  const pose = { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };
  const candidate = { pose, unmatched: null, drawn: null, residual: 0.2, deviations: null, judged: { misfit: 0.2, verdict: GOOD }, support: 0.9 };
  const origin = poseKey(doc, 'femur', doc.frames[0]!)!;
  const result: Posed = { kind: 'posed', from: 'outline', origin, candidates: [candidate], chosen: 0, reason: null, decided: true, verdict: GOOD, onFrame: { film: null }, ...part };
  return { label: 'click', place, apply: (doc) => withCell(doc, place, { outline, result, resultOf: outline }) };
}

const rest = () => vi.advanceTimersByTimeAsync(20 * FILM_REST);

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

/** What a follower read beside a femur in frame a. */
const BESIDE: Beside = {
  model: 'femur',
  anchors: [{ frameId: 'a', pose: { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 } }],
  read: [0, 1].map((frame) => ({ component: 'femur' as const, frame, profiles: new Float32Array(64) })),
};
const sizes = ({ read }: Estimate) => read.map(({ frame, profiles }) => [frame, profiles.length]);

/** The names of the components and frames whose profiles the worker was given, call by call. */
const handed = (asked: readonly Estimate[]) => asked.map(({ read }) => read?.map(({ component, frame, profiles }) => `${component} ${frame}: ${profiles.length}`));

describe('squares that a film is read in', () => {
  it('are those of all that is read from then on, and of what was read before', async () => {
    const { store, reader, asked, sides, squares } = bench([0.026, 0.03]);
    store.perform(clicked(store.doc));
    await rest();
    // One was tried.
    expect(sides).toEqual([2, 1]);
    squares.side = 2;
    const read: number[] = [];
    const side = await reader.chooseSquares(async (tried) => (read.push(tried), BESIDE.read));
    expect([side, read]).toEqual([2, [2]]);
    reader.takeBeside('femur', BESIDE);
    await rest();
    expect(new Set(sides.slice(2))).toEqual(new Set([2]));
    expect(asked.at(-1)).toMatchObject({ side: 2 });
  });

  it('are chosen before the film is estimated, by the first pose', async () => {
    const { store, asked, sides, squares } = bench([0.026]);
    squares.side = 2;
    store.perform(clicked(store.doc));
    await rest();
    expect(sides).toEqual([2, 2]);
    expect(asked).toMatchObject([{ side: 2 }]);
  });

  it('are asked for again where the first pose told nothing', async () => {
    const { store, sides, squares } = bench([null]);
    squares.isTold = false;
    store.perform(clicked(store.doc));
    await rest();
    expect(sides).toEqual([2, 1]);
    Object.assign(squares, { side: 2, isTold: true });
    store.perform(clicked(store.doc, 'b'));
    await rest();
    expect(sides.slice(2)).toEqual([2, 2, 2, 2]);
  });

  it('are those of a film that a session brings', async () => {
    const { store, reader, asked, sides } = bench([0.026]);
    store.perform(clicked(store.doc));
    await rest();
    const known = store.doc.film.known!;
    const numbers = [...known.models.femur!.numbers, 0, 0, 0, 0, 2];
    const brought = { ...known, models: { ...known.models, femur: { of: 'femur', numbers } } };
    store.amend((doc) => ({ ...doc, film: { ...doc.film, known: brought } }));
    asked.length = sides.length = 0;
    store.perform(clicked(store.doc, 'b'));
    reader.takeBeside('femur', BESIDE);
    await rest();
    expect(new Set(sides)).toEqual(new Set([2]));
    expect(asked.at(-1)).toMatchObject({ side: 2 });
  });
});

describe('what a followed film tells of its constants', () => {
  /** A femur that was clicked in frame a, what was read beside it, and the constants by that. */
  async function followed(again: number | null) {
    const { store, reader, asked, ...rest_ } = bench([0.026, again]);
    store.perform(clicked(store.doc));
    reader.takeBeside('femur', BESIDE);
    await rest();
    asked.length = 0;
    const known = store.doc.film.known;
    const read = [0, 1].map((frame) => ({ component: 'femur' as const, frame, profiles: new Float32Array(192) }));
    const learn = async (signal = new AbortController().signal) => {
      const isNew = reader.learnAgain(new Map([['femur', { ...BESIDE, read }]]), signal);
      await rest();
      return isNew;
    };
    return { store, reader, asked, known, learn, ...rest_ };
  }

  it('is taken, with the profiles in place of those from beside the pose that led, and poses are corrected by it', async () => {
    const { store, asked, known, learn, corrected } = await followed(0.05);
    const before = corrected.length;
    expect(await learn()).toBe(true);
    expect(store.doc.film.known?.models.femur?.numbers[0]).toBe(0.05);
    expect(store.doc.film.known).not.toBe(known);
    // Compared by what was read in good frames alone; then the worker forgets what was read beside, but for the clicked frame, which is read itself.
    expect(asked[0]).toMatchObject({ followed: [{ component: 'femur', known: known?.models.femur?.numbers, read: [{ frame: 0 }, { frame: 1 }] }] });
    expect(handed(asked.slice(1, 2))).toEqual([['femur 1: 0', 'femur 1: 192']]);
    expect(corrected.length).toBeGreaterThan(before);
    expect(cellOf(store.doc, 'a', 'femur').result).toMatchObject({ onFrame: { film: [0.05, 0.8, 0.7] } });
  });

  it('changes nothing where the constants stand, or where somebody called it off', async () => {
    const stands = await followed(null);
    expect(await stands.learn()).toBe(false);
    expect(stands.store.doc.film.known).toBe(stands.known);
    expect(stands.asked).toHaveLength(1);
    const { store, known, learn } = await followed(0.05);
    const off = new AbortController();
    off.abort();
    expect(await learn(off.signal)).toBe(false);
    expect(store.doc.film.known).toBe(known);
  });
});

describe('what is read beside a pose', () => {
  const placed = (x: number) => setPoseByHand({ frameId: 'a', component: 'femur' }, { ...BESIDE.anchors[0]!.pose, x });

  it('tells the film where no pose itself does, and stays when the pose is corrected', async () => {
    const { store, reader, asked } = bench();
    store.perform(placed(0));
    await rest();
    expect([asked.length, reader.knowsBeside('femur')]).toEqual([0, false]);
    reader.takeBeside('femur', BESIDE);
    await rest();
    expect(asked.map(sizes)).toEqual([[[0, 64], [1, 64]]]);
    expect(store.doc.film.known).not.toBeNull();
    store.perform(placed(2));
    await rest();
    expect([asked.length, reader.knowsBeside('femur')]).toEqual([1, true]);
  });

  it('goes with the pose, and with the model', async () => {
    const { store, reader, asked } = bench();
    store.perform(placed(0));
    reader.takeBeside('femur', BESIDE);
    await rest();
    store.perform(placed(5));
    await rest();
    expect(asked.map(sizes).at(-1)).toEqual([[0, 0], [1, 0]]);
    reader.takeBeside('femur', { ...BESIDE, anchors: [] });
    expect(reader.knowsBeside('femur')).toBe(true);
    store.perform(setModel('femur', { name: 'another', sha256: 'another' }));
    expect(reader.knowsBeside('femur')).toBe(false);
  });

  it('gives way to a pose that tells itself, and takes its frame back', async () => {
    const { store, reader, asked } = bench();
    store.perform(clicked(store.doc));
    await rest();
    const before = asked.length;
    reader.takeBeside('femur', BESIDE);
    await rest();
    expect(sizes(asked[before]!)).toEqual([[1, 64]]);
    store.perform(placed(0));
    await rest();
    expect(sizes(asked.at(-1)!)).toEqual([[0, 64]]);
  });
});

describe('the reader of the film', () => {
  it('learns from the first pose on a frame, and corrects it with its outline; no units of undo', async () => {
    const { store, asked, corrected, z } = bench();
    store.perform(clicked(store.doc));
    const units = store.state.history.past.length;
    await rest();
    expect(asked.map(({ read }) => read.map(({ component, frame }) => `${component} ${frame}`))).toEqual([['femur 0']]);
    expect(store.doc.film.known?.words).toBe('a film');
    expect(corrected).toEqual(['femur']);
    expect(z()).toBe(-999);
    const cell = cellOf(store.doc, 'a', 'femur');
    expect(cell.outline?.points[0]).toEqual(framePoint(2, 2));
    expect(cell.resultOf).toBe(cell.outline);
    expect(cell.result).toMatchObject({ onFrame: { film: [0.026, 0.8, 0.7] }, verdict: GOOD });
    expect(store.state.history.past.length).toBe(units);
    await rest();
    expect([asked.length, corrected.length]).toEqual([1, 1]);
  });

  it('leaves a traced outline where it is, and keeps away from its unknown sides', async () => {
    const { store, hidden, z } = bench();
    const outline = { ...OUTLINE, unknownSides: [1], laidBy: 'tool' } as const;
    store.perform(clicked(store.doc, 'a', {}, outline));
    expect(isSurpassed(cellOf(store.doc, 'a', 'femur'))).toBe(false);
    await rest();
    const cell = cellOf(store.doc, 'a', 'femur');
    expect([z(), cell.outline, cell.resultOf]).toEqual([-999, outline, outline]);
    expect(isSurpassed(cell)).toBe(true);
    expect(hidden.length).toBeGreaterThan(1);
    for (const sides of hidden) expect(sides).toEqual([1]);
  });

  it('never changes what a person set', async () => {
    const { store, corrected, z } = bench();
    store.perform(clicked(store.doc, 'a', { from: 'hand' }));
    await rest();
    expect(store.doc.film.known).not.toBeNull();
    expect([corrected, z()]).toEqual([[], -1000]);
  });

  it('asks again with each new pose, and corrects all of them where that is news', async () => {
    const { store, asked, corrected } = bench([0.026, 0.02600001, 0.03]);
    store.perform(clicked(store.doc));
    await rest();
    store.perform(clicked(store.doc, 'b'));
    await rest();
    // The second estimate is no news: the new pose alone is corrected.
    expect([asked.length, corrected.length]).toEqual([2, 2]);
    expect(store.doc.film.known?.models.femur?.numbers[0]).toBe(0.026);
    store.perform(stateFilm({ ...NOTHING_STATED, display: 'logarithmic' }));
    await rest();
    expect(asked.at(-1)?.stated.display).toBe('logarithmic');
    expect([asked.length, corrected.length]).toEqual([3, 4]);
  });

  it('takes what is stated in whole, asks no frame, and goes back to them', async () => {
    const { store, asked, corrected, hidden } = bench();
    const constants = { curvature: 0.03, blur: 0.9, attenuation: { femur: 0.7, tibia: null } };
    store.perform(stateFilm({ ...NOTHING_STATED, constants }));
    await rest();
    expect(asked.map(({ read, stated }) => [read, stated.constants])).toEqual([[[], constants]]);
    store.perform(clicked(store.doc));
    await rest();
    // One look: the correction, no profiles.
    expect([corrected, hidden.length, asked.length]).toEqual([['femur'], 1, 1]);
    // Another model is another attenuation's.
    store.perform(setModel('femur', { name: 'other', sha256: 'other' }));
    await rest();
    expect([asked.length, store.doc.film.known?.models.femur?.of]).toEqual([2, 'other']);
    store.undo();
    await rest();
    store.perform(stateFilm(NOTHING_STATED));
    await rest();
    expect(asked.at(-1)?.read.map(({ component }) => component)).toEqual(['femur']);
  });

  it('corrects what never was before what was: it is held against the others as they were', async () => {
    const { store, starts } = bench([0.026, 0.03]);
    store.perform(clicked(store.doc));
    await rest();
    store.perform(clicked(store.doc, 'b'));
    await rest();
    expect(store.doc.film.known?.models.femur?.numbers[0]).toBe(0.03);
    // Both are to be corrected by then, and frame a comes first in the film.
    expect(starts).toEqual([-1000, -1000, -999]);
  });

  it('asks corrected poses again until they settle', async () => {
    const { store, asked, z } = bench([0.02, 0.025, 0.026], {}, [-985, -981, -980]);
    store.perform(clicked(store.doc));
    await rest();
    expect([asked.length, store.doc.film.known?.models.femur?.numbers[0], z()]).toEqual([3, 0.026, -980]);
  });

  it('gives up where they never do', async () => {
    const { store, asked } = bench([0.02, 0.03, 0.02, 0.03, 0.02, 0.03, 0.02], {}, [-980, -1000, -980, -1000, -980, -1000, -980]);
    store.perform(clicked(store.doc));
    await rest();
    expect(asked.length).toBe(5);
  });

  it('asks once two fifths more have come', async () => {
    const { store, asked } = bench();
    const ids = ['c', 'd', 'e', 'f', 'g'];
    store.perform(addFrames(ids.map((id) => ({ id, name: id, source: id, indexInSource: 0, width: 8, height: 8 }))));
    for (const id of ['a', 'b', 'c', 'd', 'e']) store.perform(clicked(store.doc, id));
    await rest();
    store.perform(clicked(store.doc, 'f'));
    await rest();
    expect(asked.map(({ read }) => read.length)).toEqual([5]);
    store.perform(clicked(store.doc, 'g'));
    await rest();
    expect(asked.map(({ read }) => read.length)).toEqual([5, 2]);
  });

  it('forgets a pose that is taken away, and goes back with undo', async () => {
    const { store, asked } = bench([0.026, 0.03, null, 0.03]);
    store.perform(clicked(store.doc));
    store.perform(clicked(store.doc, 'b'));
    await rest();
    store.perform(deleteOutline({ frameId: 'b', component: 'femur' }));
    await rest();
    expect(asked.at(-1)?.read.map(({ frame, profiles }) => [frame, profiles.length])).toEqual([[1, 0]]);
    store.perform(deleteOutline({ frameId: 'a', component: 'femur' }));
    await rest();
    expect(store.doc.film.known).toBeNull();
    store.undo();
    await rest();
    expect(store.doc.film.known?.models.femur?.numbers[0]).toBe(0.03);
  });

  it('has with a step back, and on again, the film that was known of those poses, and asks no frame for it', async () => {
    const { store, asked, corrected } = bench([0.026, 0.05, 0.07]);
    const curvature = () => store.doc.film.known?.models.femur?.numbers[0];
    store.perform(clicked(store.doc));
    await rest();
    store.perform(clicked(store.doc, 'b'));
    await rest();
    expect([curvature(), asked.length]).toEqual([0.05, 2]);
    store.undo();
    await rest();
    expect([curvature(), asked.length]).toEqual([0.026, 2]);
    expect(cellOf(store.doc, 'a', 'femur').result).toMatchObject({ onFrame: { film: [0.026, 0.8, 0.7] } });
    store.redo();
    await rest();
    expect([curvature(), asked.length]).toEqual([0.05, 2]);
    expect(corrected.length).toBeGreaterThan(0);
    // What comes next is told by all that is there.
    store.perform(deleteOutline({ frameId: 'a', component: 'femur' }));
    await rest();
    expect(handed(asked.slice(2))).toEqual([['femur 1: 0', 'femur 0: 0', 'femur 1: 128']]);
    expect(curvature()).toBe(0.07);
  });

  it('asks where a step back brings other poses than the film was told by', async () => {
    const { store, asked } = bench([0.026, 0.05, 0.07]);
    store.perform(clicked(store.doc));
    await rest();
    const moved = { x: 3, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };
    store.perform(clicked(store.doc, 'b'));
    await rest();
    store.amend((doc) => {
      const cell = cellOf(doc, 'a', 'femur');
      const result = cell.result as Posed;
      return withCell(doc, { frameId: 'a', component: 'femur' }, { ...cell, result: { ...result, candidates: [{ ...result.candidates[0]!, pose: moved }] } });
    });
    await rest();
    const before = asked.length;
    store.undo();
    await rest();
    expect(asked.length).toBeGreaterThan(before);
  });

  it('takes a film from a session as it is, until a new pose comes: then all are asked', async () => {
    const first = bench();
    first.store.perform(clicked(first.store.doc));
    await rest();
    const saved = first.store.doc;
    const { store, asked } = bench();
    store.perform({ label: 'open', apply: () => saved });
    await rest();
    expect(asked).toEqual([]);
    expect(store.doc.film.known).toEqual(saved.film.known);
    store.perform(clicked(store.doc, 'b'));
    await rest();
    expect(asked.map(({ read }) => read.map(({ frame }) => frame))).toEqual([[0, 1]]);
  });

  it('takes it also where frames and libraries come later, or after another work', async () => {
    const first = bench();
    first.store.perform(clicked(first.store.doc));
    await rest();
    const saved = first.store.doc;
    const { store, asked, corrected } = bench();
    store.perform(clicked(store.doc, 'b'));
    await rest();
    expect(asked.length).toBe(1);
    for (const component of ['femur', 'tibia'] as const) store.setLibrary(component, { state: 'none' });
    const before = corrected.length;
    store.perform({ label: 'open', apply: () => saved });
    await rest();
    for (const component of ['femur', 'tibia'] as const) store.setLibrary(component, { state: 'ready', key: 'k', views: 1, bytes: 1, seconds: null });
    await rest();
    expect([asked.length, corrected.length]).toEqual([1, before]);
    expect(store.doc).toBe(saved);
    store.perform(clicked(store.doc, 'b'));
    await rest();
    // The other work's pose in frame b is forgotten before that of this work is read.
    expect(asked[1]?.read.map(({ frame, profiles }) => [frame, profiles.length])).toEqual([[1, 0], [0, 128], [1, 128]]);
  });

  it('leaves a pose as it is where the film does not tell', async () => {
    const { store, corrected, z } = bench([null]);
    store.perform(clicked(store.doc));
    await rest();
    expect([store.doc.film.known, corrected, z()]).toEqual([null, [], -1000]);
  });
});
