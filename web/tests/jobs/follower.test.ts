import { describe, expect, it } from 'vitest';
import { addFrames, setCalibration, setModel, withCell } from '../../src/document/commands';
import { stateFilm } from '../../src/document/film';
import { toggleChecked } from '../../src/document/marks';
import { bare, setPoseByHand } from '../../src/document/hand_poses';
import { isSoFar } from '../../src/document/followed';
import { readSession, writeSession } from '../../src/document/session/session';
import { Store } from '../../src/document/store';
import { cellOf, chosenCandidate, type Posed, verdictOf } from '../../src/document/types';
import type { PoseNumbers } from '../../src/geometry/pose_numbers';
import { keepLeads, withLeads } from '../../src/jobs/leads';
import { spanToFollow } from '../../src/results/spans';
import { standingOf } from '../../src/results/steps';
import { Follower } from '../../src/jobs/follower';
import type { Beside } from '../../src/jobs/film_beside';
import type { ComponentName } from '../../src/terms/component';
import type { ReadProfiles } from '../../src/workers/protocol/film';
import { FRAMES, MOVED, poseOf, worker } from './fake_follow_worker';

const place = (frame: number) => ({ frameId: `f${frame}`, component: 'femur' as const });

function bench(missing: readonly number[] = []) {
  const store = new Store();
  const frames = Array.from({ length: FRAMES }, (_, k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }));
  store.perform(addFrames(frames));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
  const mesh = { vertices: new Float32Array(), triangles: new Uint32Array() };
  const studio = { framePixels: () => ({ pixels: new Uint8Array(64), width: 8, height: 8, covered: new Uint32Array() }), meshOf: () => mesh };
  const femur = worker(missing);
  const workers = { femur, tibia: worker([]) };
  const searched: string[] = [];
  const first = {
    open: async () => false,
    find: async (wanted: readonly ComponentName[]) => {
      searched.push(...wanted);
      for (const component of wanted) {
        const at = discoveries[component];
        if (at !== undefined) store.perform(setPoseByHand({ frameId: `f${at}`, component }, poseOf(0)));
      }
      return wanted.flatMap((component) => (discoveries[component] === undefined ? [] : [{ frameId: `f${discoveries[component]}`, component }]));
    },
    compare: async () => 'leads' as const,
    clickAgain: async () => undefined,
  };
  const discoveries: { femur?: number; tibia?: number } = {};
  const taken: [ComponentName, Beside][] = [];
  const tried: (readonly ReadProfiles[])[] = [];
  const film = {
    ready: async () => undefined,
    chooseSquares: async (read: (side: number) => Promise<readonly ReadProfiles[]>) => {
      tried.push(await read(2));
      return 2;
    },
    knowsBeside: async (component: ComponentName) => taken.some(([of]) => of === component),
    takeBeside: async (...beside: [ComponentName, Beside]) => void taken.push(beside),
    learnAgain: async (read: ReadonlyMap<ComponentName, Beside>) => {
      compared.push(read);
      return news.shift()?.() ?? false;
    },
  };
  const compared: ReadonlyMap<ComponentName, Beside>[] = [];
  /** What comes of comparing the film's constants, the first time, the second, ...: others or not. */
  const news: (() => boolean)[] = [];
  const follower = new Follower({ store, studio } as never, workers as never, first, film);
  const xs = () => frames.map(({ id }) => chosenCandidate(cellOf(store.doc, id, 'femur'))?.pose.x ?? null);
  return { store, follower, femur, tibia: workers.tibia, xs, searched, discoveries, taken, compared, news, tried };
}

/** A doubtful pose that a click led to. */
function clicked(store: Store, chosen = 0): void {
  const outline = { points: [], closed: true, unknownSides: [], laidBy: 'click' } as const;
  const verdict = { word: 'doubtful', because: 'a part of it lies on no edge' } as const;
  const candidates = [bare(poseOf(0)), bare(poseOf(1))];
  const judged = candidates.map((one) => ({ ...one, judged: { misfit: 1, verdict } }));
  const result: Posed = { kind: 'posed', from: 'outline', origin: 'o', candidates: judged, chosen, reason: null, decided: true, verdict };
  store.perform({ label: 'click', apply: (doc) => withCell(doc, place(2), { outline, result, resultOf: outline }) });
}

describe('following', () => {
  it('looks for a component that is set nowhere, and says so where it is not found', async () => {
    const { store, follower, xs, searched } = bench();
    await follower.follow();
    expect(searched).toEqual(['femur']);
    expect(store.ui.notice).toMatchObject({ kind: 'error', text: expect.stringContaining('The femur was not found') });
    expect(xs()).toEqual(Array(FRAMES).fill(null));
    expect(store.ui.following).toBe(false);
  });

  it('says of a component without a library why there is none', async () => {
    const { store, follower } = bench();
    store.setLibrary('femur', { state: 'stopped', key: 'k', reason: 'the calibration is for 480 x 393 pixels' });
    await follower.follow();
    expect(store.ui.notice).toMatchObject({ kind: 'error', text: 'Femur library: the calibration is for 480 x 393 pixels' });
  });

  it('goes on from where it found a component', async () => {
    const { follower, xs, discoveries } = bench();
    discoveries.femur = 2;
    await follower.follow();
    expect(xs()).toEqual([10, 11, 0, 13, 14, 15]);
  });

  it('reads the film beside what is set before it follows all through, once', async () => {
    const { store, follower, taken } = bench();
    store.perform(setPoseByHand(place(1), poseOf(0)));
    await follower.follow();
    expect(taken).toMatchObject([['femur', { model: 'm', anchors: [{ frameId: 'f1', pose: poseOf(0) }], read: [{ component: 'femur', frame: 1 }, { component: 'femur', frame: 2 }] }]]);
    store.perform(setPoseByHand(place(4), poseOf(4)));
    await follower.follow();
    expect(taken).toHaveLength(1);
  });

  it('reads the first pose alone in squares that are tried, and the film in those that are chosen', async () => {
    const { store, follower, femur, tried } = bench();
    store.perform(setPoseByHand(place(1), poseOf(0)));
    await follower.follow();
    expect(tried).toMatchObject([[{ component: 'femur', frame: 1 }]]);
    expect(femur.read).toMatchObject([
      { side: 2, justThere: true, given: [{ frame: 1 }] },
      { side: 2, justThere: false, given: [{ frame: 1 }] },
    ]);
  });

  it('reads nothing beside poses that are doubtful, or where the film is stated', async () => {
    const { store, follower, taken } = bench();
    store.perform(setPoseByHand(place(1), poseOf(0)));
    store.perform(stateFilm({ ...store.doc.film.stated, constants: { curvature: 0.02, blur: 1, attenuation: { femur: 1, tibia: 1 } } }));
    await follower.follow();
    expect(taken).toEqual([]);
  });

  it('takes a cell where a click found nothing, and undo brings its outline back', async () => {
    const { store, follower, xs } = bench();
    store.perform(setPoseByHand(place(1), poseOf(0)));
    const outline = { points: [], closed: true, unknownSides: [], laidBy: 'click' } as const;
    const cell = { outline, result: { kind: 'failed', origin: 'o', sentence: 'Nothing fits.' }, resultOf: outline } as const;
    store.perform({ label: 'click', apply: (doc) => withCell(doc, place(3), cell) });
    expect(standingOf(store.doc)).toMatchObject({ step: 'follow', free: 5 });
    await follower.follow();
    expect(xs()).toEqual([10, 0, 12, 13, 14, 15]);
    expect(cellOf(store.doc, 'f3', 'femur').outline).toBeNull();
    store.undo();
    expect(cellOf(store.doc, 'f3', 'femur')).toEqual(cell);
    // Somebody who mended the outline worked on it.
    const mended = { ...outline, laidBy: 'mixed' } as const;
    store.perform({ label: 'edit', apply: (doc) => withCell(doc, place(3), { ...cell, outline: mended }) });
    expect(standingOf(store.doc).free).toBe(4);
  });

  it('fills the frames that nobody set as one step back, with verdicts and what was not found', async () => {
    const { store, follower, xs } = bench([5]);
    store.perform(setPoseByHand(place(1), poseOf(0)));
    const counted = new Set<string>();
    store.subscribe(() => store.ui.jobs.forEach(({ title, unit }) => title === 'Following the film' && counted.add(unit)));
    await follower.follow();
    // Of two components there are twice as many as frames.
    expect([...counted]).toEqual(['poses']);
    expect(xs()).toEqual([10, 0, 12, 13, 14, null]);
    expect(store.ui.notice?.text).toBe('5 poses found, some doubtful: N goes from one to the next. 1 is missing (\u2715): a click there, or an outline, helps.');
    expect(cellOf(store.doc, 'f4', 'femur').result).toMatchObject({ from: 'film', verdict: { word: 'doubtful' }, doubt: 2, candidates: [{ pose: poseOf(14) }, { pose: poseOf(-4), residual: 0.3 }] });
    expect(cellOf(store.doc, 'f5', 'femur').result).toMatchObject({ kind: 'failed', sentence: 'As untrackable says.' });
    store.undo();
    expect(xs()).toEqual([null, 0, null, null, null, null]);
    store.redo();
    expect(xs()[2]).toBe(12);
  });

  it('does again only what lies beside a frame that was corrected', async () => {
    const { store, follower, femur, xs } = bench();
    store.perform(setPoseByHand(place(0), poseOf(0)));
    store.perform(setPoseByHand(place(3), poseOf(3)));
    await follower.follow();
    await follower.follow();
    expect(store.ui.notice?.text).toBe('Every frame is followed already from those that are set.');
    store.perform(setPoseByHand(place(5), poseOf(5)));
    await follower.follow();
    expect(femur.begun.map(({ first, last }) => [first, last])).toEqual([[0, 5], [3, 5]]);
    expect(xs()).toEqual([0, 11, 12, 3, 14, 5]);
  });

  it('never changes a followed frame that somebody checked, and goes on from it where something else changes', async () => {
    const { store, follower, femur } = bench();
    store.perform(setPoseByHand(place(0), poseOf(0)));
    await follower.follow();
    store.perform(toggleChecked(place(2)));
    await follower.follow();
    // It was right as it was, and so is what was followed with it.
    expect(store.ui.notice?.text).toBe('Every frame is followed already from those that are set.');
    store.perform(setPoseByHand(place(4), poseOf(4)));
    await follower.follow();
    expect(femur.begun.map(({ given }) => given.map(({ frame }) => frame))).toEqual([[0], [2, 4]]);
  });

  it('calls doubtful what a doubtful outline alone leads to, and leaves it out where there is better', async () => {
    const { store, follower, femur } = bench();
    const outline = { points: [], closed: true, unknownSides: [] };
    const verdict = { word: 'doubtful', because: 'a part of it lies on no edge' } as const;
    const result: Posed = { kind: 'posed', from: 'outline', origin: 'o', candidates: [bare(poseOf(0))], chosen: 0, reason: null, decided: true, verdict };
    store.perform({ label: 'trace', apply: (doc) => withCell(doc, place(0), { outline, result, resultOf: outline }) });
    await follower.follow();
    const at = (frame: number) => verdictOf(cellOf(store.doc, `f${frame}`, 'femur').result);
    expect(at(1)).toMatchObject({ word: 'doubtful', because: expect.stringContaining('followed from a pose that is doubtful') });
    store.perform(setPoseByHand(place(5), poseOf(5)));
    await follower.follow();
    expect(femur.begun.at(-1)?.given.map(({ frame }) => frame)).toEqual([5]);
    expect(at(1)?.word).toBe('good');
  });

  it('lets the film say of a pose that nobody set whether it is right, and follows from it as the film left it', async () => {
    const { store, follower, femur, xs } = bench();
    keepLeads(store);
    clicked(store);
    await follower.follow();
    expect(femur.begun[0]?.given).toMatchObject([{ frame: 2, isSet: false }]);
    const words = () => [0, 1, 2, 3, 4, 5].map((frame) => verdictOf(cellOf(store.doc, `f${frame}`, 'femur').result)?.word);
    expect(words()).toEqual(['good', 'good', 'good', 'good', 'doubtful', 'good']);
    expect(xs()).toEqual([10, 11, MOVED, 13, 14, 15]);
    expect(cellOf(store.doc, 'f2', 'femur')).toMatchObject({ outline: null, result: { from: 'film' } });
    await follower.follow();
    expect(store.ui.notice?.text).toBe('Every frame is followed already from those that are set.');
    const frame = { id: 'f6', name: 'f6', source: 's', indexInSource: 6, width: 8, height: 8 };
    store.perform(addFrames([frame]));
    expect(spanToFollow(store.doc, 'femur')).toMatchObject({ first: 2, last: 6, free: 1, isDoubtful: false });
    store.undo();
    store.perform(toggleChecked(place(4)));
    expect(spanToFollow(store.doc, 'femur')).toBeNull();
    store.perform(toggleChecked(place(2)));
    expect(spanToFollow(store.doc, 'femur')).toBeNull();
    store.perform(setPoseByHand(place(5), poseOf(5)));
    expect(spanToFollow(store.doc, 'femur')).toBeNull();
    store.perform(setPoseByHand(place(0), poseOf(0)));
    await follower.follow();
    expect(femur.begun.at(-1)?.given.map(({ frame, isSet }) => [frame, isSet])).toEqual([[0, true], [2, true]]);
  });

  it('leaves a pose that nobody set, and the doubt of it, where the film was not followed to its end', async () => {
    const { store, follower, femur, xs } = bench();
    clicked(store);
    femur.stopAt(1, () => void follower.follow());
    await follower.follow();
    expect(xs()[2]).toBe(0);
    expect(verdictOf(cellOf(store.doc, 'f2', 'femur').result)?.because).toBe('a part of it lies on no edge');
    expect(verdictOf(cellOf(store.doc, 'f0', 'femur').result)?.because).toContain('followed from a pose that is doubtful');
    femur.stopAt(-1, () => undefined);
    expect(spanToFollow(store.doc, 'femur')).toMatchObject({ first: 0, last: 5, free: 5 });
    await follower.follow();
    expect(verdictOf(cellOf(store.doc, 'f2', 'femur').result)?.word).toBe('good');
    expect(verdictOf(cellOf(store.doc, 'f0', 'femur').result)?.word).toBe('good');
  });

  it('keeps a pose that somebody chose among the answers to a click', async () => {
    const { store, follower, femur } = bench();
    clicked(store, 1);
    await follower.follow();
    expect(femur.begun[0]?.given).toMatchObject([{ frame: 2, isSet: true }]);
  });

  it('calls good what a doubtful pose led to as soon as that one is checked, and doubtful again without the check', async () => {
    const { store, follower } = bench();
    keepLeads(store);
    const outline = { points: [], closed: true, unknownSides: [] };
    const verdict = { word: 'doubtful', because: 'a part of it lies on no edge' } as const;
    const result: Posed = { kind: 'posed', from: 'outline', origin: 'o', candidates: [bare(poseOf(0))], chosen: 0, reason: null, decided: true, verdict };
    store.perform({ label: 'trace', apply: (doc) => withCell(doc, place(0), { outline, result, resultOf: outline }) });
    await follower.follow();
    const words = () => [1, 2, 3, 4, 5].map((frame) => verdictOf(cellOf(store.doc, `f${frame}`, 'femur').result)?.word);
    expect(words()).toEqual(Array(5).fill('doubtful'));
    const kept = readSession(writeSession({ doc: store.doc, view: { frameIndex: 0, component: 'femur', overlayOpacity: 0.5 }, files: [], audit: null }, 'test', new Date(0)).join('')).doc;
    store.perform(toggleChecked(place(0)));
    // Frame 4 is doubtful by itself.
    expect(words()).toEqual(['good', 'good', 'good', 'doubtful', 'good']);
    expect(verdictOf(cellOf(store.doc, 'f1', 'femur').result)?.because).toBe('as followed says');
    expect(standingOf(store.doc)).toMatchObject({ step: 'check', free: 0, doubtful: 1 });
    store.undo();
    expect(words()).toEqual(Array(5).fill('doubtful'));
    store.redo();
    expect(words()[0]).toBe('good');
    // The machine may find it good as well, and a session knows what each frame says by itself.
    const found = withLeads(withCell(kept, place(0), { ...cellOf(kept, 'f0', 'femur'), result: { ...result, verdict: { word: 'good', because: 'it fits' } } }));
    expect(verdictOf(cellOf(found, 'f1', 'femur').result)?.word).toBe('good');
  });

  it('follows again what sessions without it call doubtful for a pose that is doubtful no more', async () => {
    const { store, follower } = bench();
    const outline = { points: [], closed: true, unknownSides: [] };
    const verdict = { word: 'doubtful', because: 'a part of it lies on no edge' } as const;
    const result: Posed = { kind: 'posed', from: 'outline', origin: 'o', candidates: [bare(poseOf(0))], chosen: 0, reason: null, decided: true, verdict };
    store.perform({ label: 'trace', apply: (doc) => withCell(doc, place(0), { outline, result, resultOf: outline }) });
    await follower.follow();
    expect(spanToFollow(store.doc, 'femur')).toBeNull();
    store.perform(toggleChecked(place(0)));
    expect(spanToFollow(store.doc, 'femur')).toMatchObject({ free: 4, isDoubtful: false });
    await follower.follow();
    expect(verdictOf(cellOf(store.doc, 'f1', 'femur').result)?.word).toBe('good');
  });

  it('fills cells as it goes, beside what a person does, and leaves nothing of that behind', async () => {
    const { store, follower, femur, xs } = bench();
    store.perform(setPoseByHand(place(0), poseOf(0)));
    await follower.follow();
    const judged = cellOf(store.doc, 'f2', 'femur').result;
    store.perform(setPoseByHand(place(0), poseOf(1)));
    let seen: unknown[] = [];
    femur.stopAt(4, () => {
      seen = [1, 2, 3, 4, 5].map((frame) => cellOf(store.doc, `f${frame}`, 'femur').result).map((result) => result && 'origin' in result && /so far/.test(result.origin));
      store.perform(setPoseByHand({ frameId: 'f0', component: 'tibia' }, poseOf(7)));
    });
    await follower.follow();
    expect(seen).toEqual([true, true, true, false, false]);
    expect(store.doc.frames.some(({ id }) => isSoFar(cellOf(store.doc, id, 'femur').result))).toBe(false);
    store.undo();
    expect(cellOf(store.doc, 'f2', 'femur').result).toBe(judged);
    expect(chosenCandidate(cellOf(store.doc, 'f0', 'tibia'))?.pose.x).toBe(7);
    store.undo();
    expect(chosenCandidate(cellOf(store.doc, 'f0', 'tibia'))).toBeNull();
    expect(cellOf(store.doc, 'f2', 'femur').result).toBe(judged);
    expect(xs()).toEqual([1, 11, 12, 13, 14, 15]);
  });

  it('chooses the sides of both at once, and the tibia’s again where the femur tells otherwise afterwards', async () => {
    const { store, follower, femur, tibia } = bench();
    store.perform(setModel('tibia', { name: 't', sha256: 't' }));
    store.perform(setPoseByHand(place(0), poseOf(0)));
    store.perform(setPoseByHand({ frameId: 'f0', component: 'tibia' }, poseOf(0)));
    tibia.doAgain(3);
    await follower.follow();
    const from = (asked: readonly string[]) => asked.slice(asked.indexOf('seeSides') + 1);
    // The femur as it was followed, and as it is in the end.
    const lost = ['middles', 'good', 'middles', 'lookBeside'];
    const answered = ['middles', 'askFilm', 'lookFilm', 'lookFilm', 'middles', 'conclude', 'compare', 'conclude', 'let go'];
    expect(from(femur.asked).toSorted()).toEqual(['conclude', 'sides', 'conclude', 'conclude', ...lost, ...answered].toSorted());
    expect(from(tibia.asked).toSorted()).toEqual(['sides', 'standsWith', 'look', ...lost, ...answered].toSorted());
    expect(from(tibia.asked).indexOf('lookBeside')).toBeGreaterThan(from(tibia.asked).indexOf('standsWith'));
  });

  it('looks for what is lost beside the other component where that is good', async () => {
    const { store, follower, femur, tibia } = bench([5]);
    store.perform(setModel('tibia', { name: 't', sha256: 't' }));
    store.perform(setPoseByHand(place(0), poseOf(0)));
    store.perform(setPoseByHand({ frameId: 'f1', component: 'tibia' }, poseOf(7)));
    tibia.lose(3);
    await follower.follow();
    const xs = (poses: readonly (PoseNumbers | null)[] | undefined) => poses?.map((pose) => pose?.x ?? null);
    // Frame 4 is doubtful.
    expect(femur.beside.map(xs)).toEqual([[10, 7, 12, 13, null, 15]]);
    expect(tibia.beside.map(xs)).toEqual([[0, 11, 12, 13, null, null]]);
    expect(tibia.asked.slice(tibia.asked.indexOf('lookBeside'))[1]).toBe('look');
  });

  it('looks beside a component that is not followed where it is shown as good', async () => {
    const { store, follower, femur } = bench();
    store.perform(setPoseByHand(place(0), poseOf(0)));
    const good = { kind: 'posed', from: 'outline', origin: 'o', candidates: [bare(poseOf(9))], chosen: 0, reason: null, decided: true, verdict: { word: 'good', because: 'it fits' } } as const;
    store.perform({ label: 'trace', apply: (doc) => withCell(doc, { frameId: 'f3', component: 'tibia' }, { outline: null, result: good, resultOf: null }) });
    await follower.follow();
    expect(femur.beside).toEqual([[null, null, null, poseOf(9), null, null]]);
  });

  it('follows the film again, once, where what it came to tells other constants, as one step back', async () => {
    const { store, follower, femur, xs, compared, news } = bench();
    store.perform(setPoseByHand(place(1), poseOf(0)));
    let shown: unknown[] = [];
    news.push(() => {
      shown = xs();
      return true;
    }, () => true);
    await follower.follow();
    expect(compared).toHaveLength(1);
    expect([...compared[0]!]).toMatchObject([['femur', { model: 'm', anchors: [{ frameId: 'f1' }], read: [{ frame: 0 }, { frame: 2 }] }]]);
    expect(femur.begun.map(({ first, last, given }) => [first, last, given.length])).toEqual([[0, 5, 1], [0, 5, 1]]);
    // What is followed so far stays in sight meanwhile.
    expect(shown).toEqual([10, 0, 12, 13, 14, 15]);
    expect(xs()).toEqual([10, 0, 12, 13, 14, 15]);
    expect(store.doc.frames.some(({ id }) => isSoFar(cellOf(store.doc, id, 'femur').result))).toBe(false);
    store.undo();
    expect(xs()).toEqual([null, 0, null, null, null, null]);
  });

  it('does not compare constants that are stated, or where a part of the film is followed or a component is good in too few frames', async () => {
    const { store, follower, femur, compared } = bench();
    const unstated = store.doc.film.stated;
    store.perform(setPoseByHand(place(1), poseOf(0)));
    store.perform(stateFilm({ ...unstated, constants: { curvature: 0.02, blur: 1, attenuation: { femur: 1, tibia: 1 } } }));
    await follower.follow();
    store.perform(stateFilm(unstated));
    store.perform(setPoseByHand(place(3), poseOf(3)));
    await follower.follow();
    expect(femur.begun.at(-1)).toMatchObject({ first: 1, last: 5 });
    expect(compared).toEqual([]);
    store.perform(setPoseByHand(place(1), poseOf(1)));
    femur.isGoodInFew();
    await follower.follow();
    expect(femur.begun.at(-1)).toMatchObject({ first: 0 });
    expect(compared).toEqual([]);
  });

  it('follows again what was followed so far when the page went', async () => {
    const { store, follower, femur } = bench();
    store.perform(setPoseByHand(place(0), poseOf(0)));
    let doc = store.doc;
    femur.stopAt(5, () => void (doc = store.doc));
    await follower.follow();
    expect([1, 2, 3, 4].map((frame) => isSoFar(cellOf(doc, `f${frame}`, 'femur').result))).toEqual([true, true, true, true]);
    expect(spanToFollow(doc, 'femur')).toMatchObject({ first: 0, last: 5, free: 5 });
    expect(spanToFollow(store.doc, 'femur')).toBeNull();
  });

  it('keeps what the film came to where it is stopped while it is followed again, to be followed again by the next press', async () => {
    const { store, follower, femur, xs, news } = bench();
    clicked(store);
    news.push(() => {
      femur.stopAt(3, () => void follower.follow());
      return true;
    });
    await follower.follow();
    expect(store.ui.notice?.text).toMatch(/^Stopped: 6 poses found/);
    expect(xs()).toEqual([10, 11, 0, 13, 14, 15]);
    expect(spanToFollow(store.doc, 'femur')).toMatchObject({ first: 0, last: 5, free: 5 });
    femur.stopAt(-1, () => undefined);
    await follower.follow();
    expect(xs()).toEqual([10, 11, MOVED, 13, 14, 15]);
    expect(spanToFollow(store.doc, 'femur')).toBeNull();
  });

  it('lets its workers go at the end, and none before', async () => {
    const { store, follower, femur, tibia } = bench();
    store.perform(setPoseByHand(place(0), poseOf(0)));
    await follower.follow();
    const endings = ({ asked }: { readonly asked: readonly string[] }) => asked.filter((method) => method === 'let go').length;
    expect([endings(femur), endings(tibia), femur.asked.at(-1), tibia.asked.at(-1)]).toEqual([1, 1, 'let go', 'let go']);
    store.perform(setPoseByHand(place(5), poseOf(0)));
    femur.stopAt(3, () => void follower.follow());
    await follower.follow();
    expect([endings(femur), endings(tibia), femur.asked.at(-1)]).toEqual([2, 2, 'let go']);
  });

  it('keeps what there is when it is stopped', async () => {
    const { store, follower, femur, xs } = bench();
    store.perform(setPoseByHand(place(0), poseOf(0)));
    femur.stopAt(3, () => void follower.follow());
    await follower.follow();
    expect(store.ui.following).toBe(false);
    expect(store.ui.notice?.text).toBe('Stopped: 4 poses found.');
    expect(xs()).toEqual([0, 11, 12, 13, null, null]);
    expect(cellOf(store.doc, 'f5', 'femur').result).toBeNull();
  });

  it('stops where model or calibration become others, and takes nothing that was found with the one before', async () => {
    for (const change of [setModel('femur', { name: 'other', sha256: 'other' }), setCalibration({ name: 'other', text: 'other' })]) {
      const { store, follower, femur, xs } = bench();
      store.perform(setPoseByHand(place(0), poseOf(0)));
      await follower.follow();
      expect(xs()).toEqual([0, 11, 12, 13, 14, 15]);
      // All but what somebody set is followed from another pose, and in the middle of it is of another model.
      store.perform(setPoseByHand(place(0), poseOf(5)));
      femur.stopAt(3, () => store.perform(change));
      await follower.follow();
      expect(xs()).toEqual([5, null, null, null, null, null]);
      expect(store.ui.following).toBe(false);
    }
  });

  it('comes back from a session file', async () => {
    const { store, follower } = bench();
    store.perform(setPoseByHand(place(0), poseOf(0)));
    await follower.follow();
    const view = { frameIndex: 0, component: 'femur', overlayOpacity: 0.5 } as const;
    const text = writeSession({ doc: store.doc, view, files: [], audit: null }, 'test', new Date(0)).join('');
    expect(cellOf(readSession(text).doc, 'f2', 'femur').result).toEqual(cellOf(store.doc, 'f2', 'femur').result);
  });
});
