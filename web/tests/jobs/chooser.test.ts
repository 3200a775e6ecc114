import { describe, expect, it, vi } from 'vitest';
import { addFrames, chooseCandidate, setModel, withCell } from '../../src/document/commands';
import type { Place } from '../../src/document/command';
import { Store } from '../../src/document/store';
import { type Axes, type Candidate, cellOf, type Outline, type Posed } from '../../src/document/types';
import type { PoseNumbers } from '../../src/geometry/pose_numbers';
import { setAxes } from '../../src/document/axes';
import { toggleChecked } from '../../src/document/marks';
import { setPoseByHand, withHandVerdict } from '../../src/document/hand_poses';
import { directionsFromWords, type Directions } from '../../src/geometry/axes';
import { COMPONENT_NAMES, type ComponentName } from '../../src/terms/component';
import { Chooser } from '../../src/jobs/chooser';
import type { PoseProtocol } from '../../src/workers/protocol/pose';
import type { Surroundings } from '../../src/workers/protocol/match';
import { surroundingsOf } from '../../src/results/surroundings';
import { framePoint } from '../../src/geometry/points';

const outline: Outline = { points: [framePoint(1, 1), framePoint(9, 1), framePoint(5, 9)], closed: true, unknownSides: [] };
const poseOf = (x: number): PoseNumbers => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });
const judged = { misfit: 0.4, verdict: { word: 'good', because: 'it fits' } } as const;
const candidate = (x: number): Candidate => ({ pose: poseOf(x), unmatched: 1, drawn: 1, residual: 0.3, deviations: null, judged });

const told = (words: string): Axes => ({ directions: directionsFromWords(words) as Directions, from: 'shape', told: 'all' });
const AXES: Record<ComponentName, Axes> = { femur: told('x y z'), tibia: told('y z x') };

function posed(decided: boolean, ...xs: number[]): Posed {
  const reason = decided ? 'By the residual.' : 'Undecided.';
  return { kind: 'posed', from: 'outline', origin: 'k', candidates: xs.map(candidate), chosen: 0, reason, decided, verdict: null };
}

const at = (frameId: string, component: ComponentName): Place => ({ frameId, component });

/** Three frames, and a worker that chooses the second pose and says on what it did. */
function bench(doubt: string | null = null) {
  const store = new Store();
  const asked: PoseProtocol['choose']['input'][] = [];
  const call = async (_: string, input: PoseProtocol['choose']['input']) => {
    asked.push(input);
    return { index: 1, decided: true, reason: 'By the coronal tilt.', doubt };
  };
  new Chooser({ store, studio: { meshOf: () => null } as never }, { call } as unknown as ConstructorParameters<typeof Chooser>[1]);
  const frame = (id: string) => ({ id, name: id, source: id, indexInSource: 0, width: 10, height: 10 });
  store.perform(addFrames(['a', 'b', 'c'].map(frame)));
  for (const component of COMPONENT_NAMES) store.perform(setAxes(component, AXES[component]));
  const put = (place: Place, result: Posed) =>
    store.amend((doc) => withCell(doc, place, { outline, result, resultOf: outline }));
  const shown = (place: Place) => {
    const { result } = cellOf(store.doc, place.frameId, place.component);
    return result?.kind === 'posed' ? result : null;
  };
  return { store, asked, put, shown };
}

const settled = () => new Promise((resolve) => setTimeout(resolve, 5));

describe('chooser', () => {
  it('leaves rivals alone while nothing is known around them', async () => {
    const { asked, put } = bench();
    put(at('b', 'tibia'), posed(false, 1, 2));
    put(at('b', 'femur'), posed(false, 3, 4));
    await settled();
    expect(asked).toEqual([]);
  });

  it.each([
    [null, { word: 'good', because: 'it fits' }],
    ['another pose fits as well', { word: 'doubtful', because: 'another pose fits as well' }],
  ])('gives a verdict anew: doubt %s', async (doubt, verdict) => {
    const { asked, put, shown } = bench(doubt);
    put(at('b', 'tibia'), posed(false, 1, 2));
    put(at('b', 'femur'), posed(true, 3));
    await vi.waitFor(() => expect(shown(at('b', 'tibia'))?.verdict).toEqual(verdict));
    expect(asked[0]?.candidates.map(({ residual }) => residual)).toEqual([0.4, 0.4]);
  });

  it('chooses anew when the other component is decided, and puts the chosen one first', async () => {
    const { asked, put, shown } = bench();
    put(at('b', 'tibia'), posed(false, 1, 2));
    put(at('b', 'femur'), posed(true, 3));
    await vi.waitFor(() => expect(shown(at('b', 'tibia'))?.decided).toBe(true));
    expect(asked.map(({ component, around }) => [component, around.counterpart?.pose.x])).toEqual([['tibia', 3]]);
    expect(shown(at('b', 'tibia'))).toMatchObject({ chosen: 0, reason: 'By the coronal tilt.' });
    expect(shown(at('b', 'tibia'))?.candidates.map(({ pose }) => pose.x)).toEqual([2, 1]);
  });

  it('asks once for what is known, and spreads from frame to frame', async () => {
    const { asked, put, shown } = bench();
    for (const frame of ['a', 'b', 'c']) put(at(frame, 'tibia'), posed(false, 1, 2));
    put(at('a', 'femur'), posed(true, 3));
    await vi.waitFor(() => expect(shown(at('c', 'tibia'))?.decided).toBe(true));
    expect(asked.length).toBe(3);
    expect(asked[2]?.around).toEqual({ counterpart: null, neighbours: [poseOf(2)] });
  });

  it('does not touch what a person chose, nor what is decided', async () => {
    const { store, asked, put, shown } = bench();
    put(at('b', 'tibia'), posed(false, 1, 2));
    store.perform(chooseCandidate(at('b', 'tibia'), 1));
    put(at('b', 'femur'), posed(true, 3, 4));
    await settled();
    expect(asked).toEqual([]);
    expect(shown(at('b', 'tibia'))?.chosen).toBe(1);
  });

  it('chooses anew what was decided and is doubtful all the same', async () => {
    const { put, shown } = bench();
    put(at('b', 'tibia'), { ...posed(true, 1, 2), verdict: { word: 'doubtful', because: 'another pose fits as well' } });
    put(at('b', 'femur'), { ...posed(true, 3), verdict: { word: 'good', because: 'it fits' } });
    await vi.waitFor(() => expect(shown(at('b', 'tibia'))?.verdict?.word).toBe('good'));
    expect(shown(at('b', 'tibia'))?.candidates.map(({ pose }) => pose.x)).toEqual([2, 1]);
  });

  it('chooses anew when a person says that the axes are others', async () => {
    const { store, asked, put, shown } = bench();
    put(at('b', 'femur'), posed(true, 3));
    put(at('b', 'tibia'), posed(true, 1, 2));
    await settled();
    expect(asked).toEqual([]);
    store.perform(setAxes('tibia', told('x y z')));
    await vi.waitFor(() => expect(shown(at('b', 'tibia'))?.reason).toBe('By the coronal tilt.'));
    expect(asked[0]?.around.counterpart?.own).toEqual(told('x y z').directions);
  });

  it('makes no unit of undo', async () => {
    const { store, put, shown } = bench();
    const units = store.state.history.past.length;
    put(at('b', 'tibia'), posed(false, 1, 2));
    put(at('b', 'femur'), posed(true, 3));
    await vi.waitFor(() => expect(shown(at('b', 'tibia'))?.decided).toBe(true));
    expect(store.state.history.past.length).toBe(units);
  });
});

describe('surroundings', () => {
  const round = (store: Store): Surroundings => surroundingsOf(store.doc, 'b', 'tibia');

  it('are poses that were decided, chosen by hand, or read from a file', () => {
    const { store, put } = bench();
    put(at('a', 'tibia'), posed(true, 1));
    put(at('c', 'tibia'), { ...posed(false, 2), from: 'file', candidates: [{ ...candidate(2), residual: null }] });
    put(at('b', 'femur'), { ...posed(false, 3, 4), chosen: 1 });
    const counterpart = { pose: poseOf(4), axes: AXES.femur.directions, own: AXES.tibia.directions };
    expect(round(store)).toEqual({ counterpart, neighbours: [poseOf(1), poseOf(2)] });
  });

  it('are not poses of the library, undecided ones, or those of an outline that has changed', () => {
    const { store, put } = bench();
    put(at('a', 'tibia'), posed(false, 1));
    put(at('c', 'tibia'), { ...posed(true, 2), candidates: [{ ...candidate(2), residual: null }] });
    store.amend((doc) => withCell(doc, at('b', 'femur'), { outline: { ...outline }, result: posed(true, 3), resultOf: outline }));
    expect(round(store)).toEqual({ counterpart: null, neighbours: [] });
  });

  it('have no counterpart while the axes of either model are not known', () => {
    const { store, put } = bench();
    put(at('b', 'femur'), posed(true, 3));
    store.perform(setAxes('femur', { ...AXES.femur, told: 'not the front' }));
    expect(round(store).counterpart?.pose).toEqual(poseOf(3));
    store.perform(setAxes('femur', { ...AXES.femur, told: 'nothing' }));
    expect(round(store).counterpart).toBeNull();
    store.perform(setAxes('femur', AXES.femur));
    // While the shape of its model is being looked at.
    store.perform(setModel('tibia', { name: 'tray.stl', sha256: 't' }));
    store.perform(setAxes('tibia', null));
    expect(round(store).counterpart).toBeNull();
  });

  const doubtful = { word: 'doubtful', because: 'a part is hidden' } as const;

  it('are not doubtful poses, decided or not, unless a person has checked them', () => {
    const { store, put } = bench();
    put(at('a', 'tibia'), { ...posed(true, 1), verdict: doubtful });
    put(at('b', 'femur'), { ...posed(true, 3), verdict: doubtful });
    put(at('c', 'tibia'), { ...posed(true, 2), verdict: { word: 'good', because: 'it fits' } });
    expect(round(store)).toEqual({ counterpart: null, neighbours: [poseOf(2)] });
    store.perform(toggleChecked(at('b', 'femur')));
    expect(round(store).counterpart?.pose).toEqual(poseOf(3));
  });

  it('are poses by hand, until those are called doubtful', () => {
    const { store } = bench();
    const place = at('b', 'femur');
    store.perform(setPoseByHand(place, poseOf(5)));
    expect(round(store).counterpart?.pose).toEqual(poseOf(5));
    const { result } = cellOf(store.doc, 'b', 'femur');
    store.amend((doc) => withHandVerdict(doc, place, result as Posed, doubtful));
    expect(round(store).counterpart).toBeNull();
  });
});
