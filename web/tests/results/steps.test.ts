import { describe, expect, it } from 'vitest';
import { takeFirstTool } from '../../src/commands/first_tool';
import { addFrames, addPoint, setCalibration, setModel, withCell } from '../../src/document/commands';
import { bare, setPoseByHand } from '../../src/document/hand_poses';
import { toggleChecked } from '../../src/document/marks';
import { Store } from '../../src/document/store';
import type { Posed } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import { componentMeant, componentToOutline, guideOf, standingOf, whatIsMissing } from '../../src/results/steps';
import type { ComponentName } from '../../src/terms/component';

const FRAMES = 3;
const place = (frame: number, component: ComponentName) => ({ frameId: `f${frame}`, component });
const POSE = { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };
const SQUARE = [framePoint(2, 2), framePoint(6, 2), framePoint(6, 6), framePoint(2, 6)];

function opened(): Store {
  const store = new Store();
  takeFirstTool(store);
  store.perform(addFrames(Array.from({ length: FRAMES }, (_, k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }))));
  return store;
}

/** What one click gives. */
function clicked(store: Store, frame: number, component: ComponentName, word: 'good' | 'doubtful' = 'good'): void {
  const outline = { points: SQUARE, closed: true, unknownSides: [] };
  const verdict = { word, because: 'it is so' };
  const result: Posed = { kind: 'posed', from: 'outline', origin: 'o', candidates: [bare(POSE)], chosen: 0, reason: null, decided: true, verdict };
  store.perform({ label: 'click', apply: (doc) => withCell(doc, place(frame, component), { outline, result, resultOf: outline }) });
}

function ready(): Store {
  const store = opened();
  store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
  store.perform(setModel('tibia', { name: 't', sha256: 't' }));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  return store;
}

describe('what is missing', () => {
  it('is asked for before anything can be followed: the calibration, then a model', () => {
    expect(whatIsMissing(new Store().doc)).toBeNull();
    const store = opened();
    expect(whatIsMissing(store.doc)).toBe('calibration');
    store.perform(setCalibration({ name: 'c', text: 'c' }));
    expect(whatIsMissing(store.doc)).toBe('femur');
    store.perform(setModel('tibia', { name: 't', sha256: 't' }));
    expect(whatIsMissing(store.doc)).toBeNull();
  });
});

describe('the first tool', () => {
  it('is one click as soon as nothing is missing for it', () => {
    const store = opened();
    expect(store.ui.tool).toBe('trace');
    expect(guideOf(store.state)).toBeNull();
    store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
    expect(store.ui.tool).toBe('trace');
    store.perform(setCalibration({ name: 'c', text: 'c' }));
    expect(store.ui.tool).toBe('one-click');
  });

  it('leaves the tool to who traces already', () => {
    const store = opened();
    store.perform(addPoint(place(0, 'femur'), framePoint(1, 1)));
    store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
    store.perform(setCalibration({ name: 'c', text: 'c' }));
    expect(store.ui.tool).toBe('trace');
    store.show({ tool: 'one-click' });
    store.perform(setCalibration(null));
    expect(store.ui.tool).toBe('trace');
  });
});

describe('the card on the film', () => {
  it('asks for a click into each component, then to follow, then for nothing', () => {
    const store = ready();
    store.setLibrary('femur', { state: 'building', key: 'k' });
    expect(guideOf(store.state)).toEqual({ ask: 'click', component: 'femur', isPreparing: true });
    clicked(store, 0, 'femur');
    expect(guideOf(store.state)).toEqual({ ask: 'click', component: 'tibia', isPreparing: false });
    clicked(store, 1, 'tibia');
    expect(guideOf(store.state)).toEqual({ ask: 'follow' });
    for (const frame of [0, 1, 2]) store.perform(setPoseByHand(place(frame, 'femur'), POSE));
    expect(guideOf(store.state)).toEqual({ ask: 'follow' });
    for (const frame of [0, 1, 2]) store.perform(setPoseByHand(place(frame, 'tibia'), POSE));
    expect(guideOf(store.state)).toBeNull();
  });

  it('is not there for who traces', () => {
    const store = ready();
    store.show({ tool: 'trace' });
    expect(guideOf(store.state)).toBeNull();
  });
});

describe('a click', () => {
  it('beside what is found means the component that is missing, and inside it that one again', () => {
    const store = ready();
    expect(componentMeant(store.state, framePoint(7, 7))).toBe('femur');
    clicked(store, 0, 'femur');
    expect(componentMeant(store.state, framePoint(7, 7))).toBe('tibia');
    expect(componentMeant(store.state, framePoint(4, 4))).toBe('femur');
    store.goTo(1);
    expect(componentMeant(store.state, framePoint(7, 7))).toBe('femur');
    store.goTo(0);
    clicked(store, 1, 'tibia');
    store.goTo(0);
    expect(componentMeant(store.state, framePoint(7, 7))).toBe('femur');
  });
});

describe('a tool that outlines', () => {
  it('is of the component that the card asks for, once the selected one has its outline', () => {
    const store = ready();
    expect(componentToOutline(store.state)).toBe('femur');
    clicked(store, 0, 'femur');
    store.show({ tool: 'trace' });
    expect(componentToOutline(store.state)).toBe('tibia');
    store.goTo(1);
    expect(componentToOutline(store.state)).toBe('femur');
    store.goTo(0);
    clicked(store, 1, 'tibia');
    expect(componentToOutline(store.state)).toBe('femur');
  });
});

describe('a click while the one before is worked on', () => {
  it('means the other component, unless it is the same place', () => {
    const store = ready();
    const at = framePoint(4, 4);
    store.setJob({ id: 1, title: 'j', done: 0, total: 0, unit: '', startedAt: 0, cancel: () => undefined, place: place(0, 'femur'), at });
    expect(guideOf(store.state)).toMatchObject({ ask: 'click', component: 'tibia' });
    expect(componentMeant(store.state, framePoint(7, 7))).toBe('tibia');
    expect(componentMeant(store.state, framePoint(4.1, 4))).toBe('femur');
  });
});

describe('steps', () => {
  it('go from opening to the joint', () => {
    const store = opened();
    expect(standingOf(store.doc).step).toBe('open');
    const all = ready();
    expect(standingOf(all.doc).step).toBe('first');
    clicked(all, 0, 'femur');
    expect(standingOf(all.doc)).toMatchObject({ step: 'first', unposed: ['tibia'] });
    clicked(all, 0, 'tibia');
    expect(standingOf(all.doc)).toMatchObject({ step: 'follow', free: 4 });
    for (const frame of [1, 2]) for (const component of ['femur', 'tibia'] as const) clicked(all, frame, component, component === 'femur' ? 'good' : 'doubtful');
    expect(standingOf(all.doc)).toMatchObject({ step: 'check', doubtful: 2 });
    all.perform(toggleChecked(place(1, 'tibia')));
    all.perform(toggleChecked(place(2, 'tibia')));
    expect(standingOf(all.doc).step).toBe('joint');
  });
});
