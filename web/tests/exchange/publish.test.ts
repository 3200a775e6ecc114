import { describe, expect, it } from 'vitest';
import { addFrames, setRate, setSide, withCell } from '../../src/document/commands';
import { bare } from '../../src/document/hand_poses';
import { setNote, toggleChecked } from '../../src/document/marks';
import { Store } from '../../src/document/store';
import type { Posed, Result } from '../../src/document/types';
import { publishedFilm } from '../../src/exchange/publish';
import { faultsOf } from '../../src/results/joint_faults';
import type { JointNumbers } from '../../src/results/joint_curves';
import { COMPONENT_NAMES, type ComponentName } from '../../src/terms/component';

const POSE = { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };
const OUTLINE = { points: [], closed: true, unknownSides: [] };

/** A knee whose poses are refined and good. */
function film(frames: number): Store {
  const store = new Store();
  store.perform(addFrames(Array.from({ length: frames }, (_, k) => ({ id: `f${k}`, name: `${k}.png`, source: `s${k}`, indexInSource: 0, width: 8, height: 8 }))));
  store.perform(setSide('left'));
  for (let frame = 0; frame < frames; frame++) for (const component of COMPONENT_NAMES) set(store, frame, component, posed());
  return store;
}

function posed(change: Partial<Posed> = {}): Posed {
  return { kind: 'posed', from: 'outline', origin: 'o', candidates: [{ ...bare(POSE), residual: 0.2 }], chosen: 0, reason: null, decided: true, verdict: { word: 'good', because: 'it fits' }, ...change };
}

function set(store: Store, frame: number, component: ComponentName, result: Result): void {
  store.amend((doc) => withCell(doc, { frameId: `f${frame}`, component }, { outline: OUTLINE, result, resultOf: OUTLINE }));
}

function numbers(frames: number): JointNumbers {
  return { columns: ['flexion_deg'], hasPlate: false, plate: new Float64Array(), otherSide: null, impossible: new Map(), originsApart: null, of: new Map(Array.from({ length: frames }, (_, k) => [`f${k}`, Float64Array.of(k)])), waiting: 0 };
}

describe('what is published', () => {
  it('has a frame for each, with its numbers, its doubts in words, and whether somebody checked it', async () => {
    const store = film(4);
    set(store, 1, 'tibia', posed({ verdict: { word: 'doubtful', because: 'its mirror image fits as well' } }));
    set(store, 2, 'femur', { kind: 'failed', origin: 'o', sentence: 'It is not there.' });
    for (const component of COMPONENT_NAMES) store.perform(toggleChecked({ frameId: 'f3', component }));
    store.perform(setRate(15));
    const { frames, rate } = await publishedFilm(store.doc, { ...numbers(4), of: new Map([['f0', Float64Array.of(7)]]) });
    expect(frames.map(({ numbers: row }) => row && [...row])).toEqual([[7], null, null, null]);
    expect(frames.map(({ doubt }) => doubt)).toEqual([null, 'tibia doubtful: its mirror image fits as well', 'femur no pose: It is not there.', null]);
    expect(frames.map(({ checked }) => checked)).toEqual([false, false, false, true]);
    expect(rate).toBe(15);
  });

  it('counts what a person has accepted, and tells what made it doubtful', async () => {
    const store = film(2);
    set(store, 1, 'tibia', posed({ verdict: { word: 'doubtful', because: 'its mirror image fits as well' } }));
    const place = { frameId: 'f1', component: 'tibia' } as const;
    store.perform(toggleChecked(place));
    const { frames } = await publishedFilm(store.doc, numbers(2));
    expect(frames[1]?.doubt).toBeNull();
    expect(frames.map(({ accepted }) => accepted)).toEqual([null, 'tibia: its mirror image fits as well']);
    expect(faultsOf(store.doc).doubtful).toEqual([]);
    // An acceptance is of what was looked at.
    set(store, 1, 'tibia', posed({ candidates: [{ ...bare({ ...POSE, x: 1 }), residual: 0.2 }], verdict: { word: 'doubtful', because: 'so' } }));
    expect((await publishedFilm(store.doc, numbers(2))).frames[1]?.doubt).toBe('tibia doubtful: so');
    expect(faultsOf(store.doc).doubtful).toEqual([2]);
  });

  it('says how poses were found, and which frames were not refined or checked', async () => {
    const store = film(3);
    set(store, 1, 'femur', posed({ from: 'hand', candidates: [bare(POSE)], verdict: null }));
    store.amend((doc) => ({ ...doc, unread: ['0003.png'] }));
    for (const component of COMPONENT_NAMES) store.perform(toggleChecked({ frameId: 'f0', component }));
    store.perform(setNote({ frameId: 'f1', component: 'tibia' }, ' blurred,\nsee <3> '));
    const { settings, remarks } = await publishedFilm(store.doc, numbers(3));
    expect(settings).toContainEqual(['poses of the femur', 'refined: 2 of 3; by hand: 1 of 3']);
    expect(remarks[0]).toBe('Frames that could not be read: 0003.png. They are not counted, neither in numbers of frames nor in times.');
    expect(remarks).toContain('Frames with a pose that was not refined: 2 (1 of 3).');
    expect(remarks).toContain('Note on the tibia in frame 2: blurred, see <3>');
    expect(remarks).toContain('Frames of which no person has checked both poses: 2\u20133 (2 of 3).');
  });

  it('names a few files of frames, and many by one digest that their order changes', async () => {
    const few = await publishedFilm(film(3).doc, numbers(3));
    expect(few.inputs.filter(({ what }) => what === 'frames').map(({ sha256 }) => sha256)).toEqual(['s0', 's1', 's2']);
    const many = film(20).doc;
    const [one] = (await publishedFilm(many, numbers(20))).inputs;
    const [other] = (await publishedFilm({ ...many, frames: many.frames.toReversed() }, numbers(20))).inputs;
    expect(one?.name).toMatch(/^20 files, 0\.png to 19\.png/);
    expect(one?.sha256).toMatch(/^[0-9a-f]{64}$/);
    expect(other?.sha256).not.toBe(one?.sha256);
  });
});
