import { describe, expect, it } from 'vitest';
import { addFrames, setCalibration, setModel, withCell } from '../../src/document/commands';
import { bare } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { cellOf } from '../../src/document/types';
import { faultsOf } from '../../src/results/joint_faults';
import { asWritten } from '../../src/results/outdated';
import { poseKey } from '../../src/results/keys';
import { progressOf } from '../../src/results/progress';
import { markOf, toggleChecked } from '../../src/document/marks';
import { poseTable } from '../../src/document/session/table';
import { setLibrarySpec } from '../../src/document/commands';

const frames = Array.from({ length: 4 }, (_, k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }));
const poseOf = (x: number) => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });

function begin(): Store {
  const store = new Store();
  store.perform(addFrames(frames));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
  return store;
}

/** A good, refined pose of an outline, found with what the document has. */
function pose(store: Store, frame: number): void {
  const place = { frameId: `f${frame}`, component: 'femur' } as const;
  const outline = { points: [], closed: true, unknownSides: [] };
  const origin = poseKey(store.doc, 'femur', frames[frame]!)!;
  const candidate = { ...bare(poseOf(frame)), residual: 0.2 };
  store.perform({ label: 'p', apply: (doc) => withCell(doc, place, { outline, resultOf: outline, result: { kind: 'posed', from: 'outline', origin, candidates: [candidate], chosen: 0, reason: null, decided: true, verdict: { word: 'good', because: 'b' } } }) });
  store.perform(toggleChecked(place));
}

describe('what is told of poses before they are written', () => {
  it('has those that were found with another library', () => {
    const store = begin();
    for (let k = 0; k < 4; k++) pose(store, k);
    // Its library is built anew; somebody calls that off, or it is not there yet.
    store.perform(setLibrarySpec('femur', { views: 'all directions', distance: 700 }));
    const cell = cellOf(store.doc, 'f0', 'femur');
    expect(progressOf(cell, markOf(store.doc, { frameId: 'f0', component: 'femur' }), poseKey(store.doc, 'femur', frames[0]!)).outdated).toBe(true);
    const faults = faultsOf(store.doc, ['femur']);
    expect(faults.outdated).toEqual([1, 2, 3, 4]);
  });

  it('has those of another calibration by more than that nobody checked them, and tables do not call them good', () => {
    const store = begin();
    for (let k = 0; k < 4; k++) pose(store, k);
    store.perform(setCalibration({ name: 'another', text: 'another' }));
    const { unchecked: _, ...faults } = faultsOf(store.doc, ['femur']);
    expect(faults.outdated).toEqual([1, 2, 3, 4]);
    const [, first] = poseTable(asWritten(store.doc), 'femur').split('\r\n');
    expect(first).not.toMatch(/,good,/);
  });
});
