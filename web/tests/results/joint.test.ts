import { describe, expect, it } from 'vitest';
import { addFrames, setSide, withCell } from '../../src/document/commands';
import { bare } from '../../src/document/hand_poses';
import { toggleChecked } from '../../src/document/marks';
import { Store } from '../../src/document/store';
import type { Posed } from '../../src/document/types';
import { curvesShown, impossibilitiesOf, type JointNumbers, linesOf, pointAt, pointsOf, rangeOf } from '../../src/results/joint_curves';
import { faultsOf, inRuns, toldTogether } from '../../src/results/joint_faults';
import { jointAsked, motionNeeds, runsOf } from '../../src/results/motion';
import { COMPONENT_NAMES, type ComponentName } from '../../src/terms/component';
import { DEFAULT_EXPORTING } from '../../src/terms/exporting';

const POSE = { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };
const COLUMNS = ['flexion_deg', 'field_medial_mm', 'sd_flexion_deg', 'sd_field_medial_mm'];

/** A left knee of six frames; the fourth has no tibia. */
function film(): Store {
  const store = new Store();
  store.perform(addFrames(Array.from({ length: 6 }, (_, k) => ({ id: `f${k}`, name: `f,${k}.png`, source: 's', indexInSource: k, width: 8, height: 8 }))));
  store.perform(setSide('left'));
  for (let frame = 0; frame < 6; frame++) for (const component of COMPONENT_NAMES) if (frame !== 3 || component === 'femur') pose(store, frame, component);
  return store;
}

function pose(store: Store, frame: number, component: ComponentName, change: Partial<Posed> = {}, residual: number | null = 0.2): void {
  const outline = { points: [], closed: true, unknownSides: [] };
  const result: Posed = { kind: 'posed', from: 'outline', origin: 'o', candidates: [{ ...bare(POSE), residual }], chosen: 0, reason: null, decided: true, verdict: { word: 'good', because: 'a test, so' }, ...change };
  store.amend((doc) => withCell(doc, { frameId: `f${frame}`, component }, { outline, result, resultOf: outline }));
}

const row = (...numbers: number[]) => Float64Array.from(numbers);

/** Of a knee that bends and comes back. */
function numbers(): JointNumbers {
  const flexions = [0, 20, 40, NaN, 30, 10];
  const rows = flexions.flatMap((flexion, k): [string, Float64Array][] => (Number.isNaN(flexion) ? [] : [[`f${k}`, row(flexion, -k, 0.1, k === 1 ? NaN : 2)]]));
  return { columns: COLUMNS, hasPlate: false, plate: new Float64Array(), otherSide: null, of: new Map(rows), impossible: new Map(), originsApart: null, waiting: 0 };
}

describe('curves of a joint', () => {
  it('have no line across a frame without both poses, whatever they run over', () => {
    const { doc } = film();
    for (const over of ['frame', 'time', 'flexion'] as const) {
      const points = pointsOf(doc, numbers(), 'field_medial_mm', { over, rate: 10 });
      expect(runsOf(points).map((run) => run.map(({ index }) => index))).toEqual([[0, 1, 2], [4, 5]]);
    }
  });

  it('are found by their frame as a search through all of them finds them', () => {
    const points = pointsOf(film().doc, numbers(), 'field_medial_mm', { over: 'frame', rate: 10 });
    for (let index = -1; index < 8; index++) expect(pointAt(points, index)).toBe(points.find((point) => point.index === index));
  });

  it('run over numbers of frames, seconds, or flexion', () => {
    const { doc } = film();
    const xs = (over: 'frame' | 'time' | 'flexion') => pointsOf(doc, numbers(), 'flexion_deg', { over, rate: 10 }).map(({ x }) => x);
    expect(xs('frame')).toEqual([1, 2, 3, 5, 6]);
    expect(xs('time')).toEqual([0, 0.1, 0.2, 0.4, 0.5]);
    expect(xs('flexion')).toEqual([0, 20, 40, 30, 10]);
  });

  it('are joined by no line where a number jumps, and leave out what no knee has', () => {
    const { doc } = film();
    const turned = numbers();
    turned.of.get('f1')![0] = 154;
    turned.of.get('f2')![0] = -165;
    const points = (told: JointNumbers) => pointsOf(doc, told, 'flexion_deg', { over: 'frame', rate: 1 });
    const joined = (told: JointNumbers) => linesOf(points(told)).map((run) => run.map(({ index }) => index));
    expect(joined(turned)).toEqual([[0], [1], [2], [4, 5]]);
    const impossible = { ...turned, impossible: new Map([['f1', 'flexion would be 154\u00b0'], ['f2', 'flexion would be -165\u00b0'], ['f4', 'it would lie behind']]) };
    expect(joined(impossible)).toEqual([[0], [5]]);
    expect(rangeOf(points(impossible))[1]).toBeLessThan(20);
    expect(impossibilitiesOf(doc, impossible)).toEqual([
      { why: 'flexion would be 154\u00b0', frames: [2, 3] },
      { why: 'it would lie behind', frames: [5] },
    ]);
  });

  it('say which points are doubtful, and which were checked in both components', () => {
    const store = film();
    pose(store, 1, 'tibia', { verdict: { word: 'doubtful', because: 'its mirror image' } });
    for (const component of COMPONENT_NAMES) store.perform(toggleChecked({ frameId: 'f2', component }));
    store.perform(toggleChecked({ frameId: 'f4', component: 'femur' }));
    const points = pointsOf(store.doc, numbers(), 'flexion_deg', { over: 'frame', rate: NaN });
    expect(points.filter(({ doubtful }) => doubtful).map(({ index }) => index)).toEqual([1]);
    expect(points.filter(({ checked }) => checked).map(({ index }) => index)).toEqual([2]);
    // Who accepts what is doubtful has looked at all of it that has to be looked at.
    store.perform(toggleChecked({ frameId: 'f1', component: 'tibia' }));
    const accepted = pointsOf(store.doc, numbers(), 'flexion_deg', { over: 'frame', rate: NaN });
    expect(accepted.filter(({ doubtful }) => doubtful)).toEqual([]);
    expect(accepted.filter(({ checked }) => checked).map(({ index }) => index)).toEqual([1, 2]);
  });

  it('leave room for their bands, but not for one that is far wider than the others', () => {
    const point = (value: number, deviation: number) => ({ index: 0, x: 0, value, deviation, doubtful: false, checked: false, impossible: false });
    const [low, high] = rangeOf([point(0, 1), point(10, 1), point(5, NaN)]);
    expect(low).toBeCloseTo(-1.48);
    expect(high).toBeCloseTo(11.48);
    const [least, most] = rangeOf([point(0, 1), point(0, 1), point(0, 1000)]);
    expect(most - least).toBeCloseTo(8 * 1.08);
    expect(rangeOf([])).toEqual([0, 1]);
  });

  it('are six, and the condyles where the tray is known', () => {
    expect(curvesShown('field', false)).toHaveLength(6);
    expect(curvesShown('grood-suntay', true)).toEqual(['flexion', 'abduction', 'internal', 'lowest', 'gsAnterior', 'gsDistraction', 'gsLateral', 'liftOff']);
  });

  it('wait for the side, and for a frame with both poses', () => {
    const store = film();
    expect(motionNeeds(store.doc)).toBeNull();
    expect(jointAsked(store.doc)?.frames.map(({ index }) => index)).toEqual([0, 1, 2, 4, 5]);
    store.perform(setSide('unknown'));
    expect(motionNeeds(store.doc)).toEqual({ what: 'side' });
    expect(jointAsked(store.doc)).toBeNull();
  });
});

describe('files of a joint', () => {
  it('tell their faults before they are written', () => {
    const store = film();
    pose(store, 0, 'femur', {}, null);
    pose(store, 1, 'femur', { from: 'file', origin: 'a.jts' }, null);
    pose(store, 2, 'tibia', { verdict: { word: 'doubtful', because: 'so' } });
    for (const component of COMPONENT_NAMES) store.perform(toggleChecked({ frameId: 'f5', component }));
    expect(faultsOf(store.doc)).toEqual({ missing: [4], unrefined: [1], unknown: [2], outdated: [], doubtful: [3], unchecked: [1, 2, 3, 5] });
  });

  it('of one component have its faults alone', () => {
    const store = film();
    pose(store, 2, 'tibia', { verdict: { word: 'doubtful', because: 'so' } });
    expect(faultsOf(store.doc, ['tibia'])).toMatchObject({ missing: [4], doubtful: [3] });
    expect(faultsOf(store.doc, ['femur'])).toMatchObject({ missing: [], doubtful: [], unchecked: [1, 2, 3, 4, 5, 6] });
  });

  it('of a file with the poses of both components are told of both, one after the other', () => {
    const told = (poses: 'jts' | 'tra' | 'folder') => toldTogether({ ...DEFAULT_EXPORTING, kind: 'poses', forms: { ...DEFAULT_EXPORTING.forms, poses } });
    expect(told('jts')).toEqual([['femur']]);
    expect(told('tra')).toEqual([['femur'], ['tibia']]);
    expect(told('folder')).toEqual([['femur'], ['tibia']]);
    expect(toldTogether({ ...DEFAULT_EXPORTING, kind: 'joint' })).toEqual([COMPONENT_NAMES]);
  });

  it('name frames in runs', () => {
    expect(inRuns([1, 2, 3, 5, 8, 9])).toBe('1–3, 5, 8–9');
    expect(inRuns([1, 3, 5, 7], 2)).toBe('1, 3 …');
  });
});
