import { describe, expect, it } from 'vitest';
import { addFrames, addPoint, closeOutline, movePoint } from '../../src/document/commands';
import type { Command, Place } from '../../src/document/command';
import { checkState, isAccepted, markOf, setNote, toggleChecked, toggleFlagged } from '../../src/document/marks';
import { entriesOf, nextTask, passes, type Filter } from '../../src/results/progress';
import { Store } from '../../src/document/store';
import { type Candidate, type Cell, cellOf, type Posed } from '../../src/document/types';
import type { ComponentName } from '../../src/terms/component';
import { framePoint } from '../../src/geometry/points';

const KEY = 'what it was found with';
const keyOf = () => KEY;
const CORNERS = [[10, 10], [50, 10], [30, 60]] as const;

/** Frames f0, f1, ... with nothing in them. */
function film(frames: number): Store {
  const store = new Store();
  const entry = (index: number) => ({ id: `f${index}`, name: `${index}.png`, source: 's', indexInSource: index, width: 100, height: 100 });
  store.perform(addFrames(Array.from({ length: frames }, (_, index) => entry(index))));
  return store;
}

const place = (frame: number, component: ComponentName = 'femur'): Place => ({ frameId: `f${frame}`, component });

function trace(store: Store, at: Place): void {
  for (const [column, row] of CORNERS) store.perform(addPoint(at, framePoint(column, row)));
  store.perform(closeOutline(at));
}

function pose(x: number): Candidate {
  return { pose: { x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 }, unmatched: 5, drawn: 6, residual: 0.2, deviations: null, judged: null };
}

function giveResult(store: Store, at: Place, result: Partial<Posed> = {}): void {
  store.amend((doc) => {
    const cell = cellOf(doc, at.frameId, at.component);
    const posed = { kind: 'posed', from: 'outline', origin: KEY, candidates: [pose(1)], chosen: 0, reason: null, decided: true, verdict: null, ...result } as const;
    return { ...doc, cells: doc.cells.with(at.frameId, at.component, { ...cell, result: posed, resultOf: cell.outline } satisfies Cell) };
  });
}

const stateOf = (store: Store, at: Place) => checkState(cellOf(store.doc, at.frameId, at.component), markOf(store.doc, at));

describe('marks', () => {
  it('are units of undo', () => {
    const store = film(1);
    const commands: Command[] = [toggleFlagged(place(0)), setNote(place(0), 'r'), setNote(place(0), 'ri'), setNote(place(0), 'rim')];
    for (const command of commands) store.perform(command);
    expect(markOf(store.doc, place(0))).toEqual({ checked: null, flagged: true, note: 'rim' });
    store.undo();
    expect(markOf(store.doc, place(0))).toEqual({ checked: null, flagged: true, note: '' });
    store.undo();
    expect(store.doc.marks).toEqual({});
    store.redo();
    store.redo();
    expect(markOf(store.doc, place(0)).note).toBe('rim');
  });

  it('leave nothing behind when they are taken away', () => {
    const store = film(1);
    for (let times = 0; times < 2; times++) store.perform(toggleFlagged(place(0)));
    expect(store.doc.marks).toEqual({});
  });

  it('a check is of what was looked at: an outline or pose that changes afterwards says so', () => {
    const store = film(1);
    store.perform(toggleChecked(place(0)));
    expect(stateOf(store, place(0))).toBe('no');
    trace(store, place(0));
    giveResult(store, place(0));
    store.perform(toggleChecked(place(0)));
    expect(stateOf(store, place(0))).toBe('yes');
    store.perform(movePoint(place(0), 0, framePoint(10.001, 10)));
    expect(stateOf(store, place(0))).toBe('changed since');
    store.undo();
    expect(stateOf(store, place(0))).toBe('yes');
    giveResult(store, place(0), { candidates: [pose(1.0001)] });
    expect(stateOf(store, place(0))).toBe('changed since');
    store.perform(toggleChecked(place(0)));
    expect(stateOf(store, place(0))).toBe('yes');
    store.perform(toggleChecked(place(0)));
    expect(stateOf(store, place(0))).toBe('no');
  });
});

describe('progress', () => {
  it('tells stages, outdated and doubtful poses apart', () => {
    const store = film(6);
    store.perform(addPoint(place(1), framePoint(1, 1)));
    for (const frame of [2, 3, 4, 5]) trace(store, place(frame));
    giveResult(store, place(3), { candidates: [{ ...pose(1), residual: null }] });
    giveResult(store, place(4), { origin: 'another model' });
    giveResult(store, place(5), { candidates: [pose(1), pose(2)], decided: false });
    const entries = entriesOf(store.doc, keyOf, ['femur']);
    expect(entries.map(({ progress }) => progress.stage)).toEqual(['empty', 'draft', 'traced', 'posed', 'refined', 'refined']);
    expect(entries.map(({ progress }) => progress.outdated)).toEqual([false, false, false, false, true, false]);
    expect(entries.map(({ progress }) => progress.doubtful)).toEqual([false, false, false, false, false, true]);
    const count = (filter: Filter) => entries.filter((entry) => passes(entry, filter)).map(({ index }) => index);
    expect(count('unfinished')).toEqual([0, 1, 2, 4]);
    expect(count('unchecked')).toEqual([3, 5]);
    expect(count('doubtful')).toEqual([5]);
    giveResult(store, place(5), { candidates: [pose(1), pose(2)], decided: false, chosen: 1 });
    expect(entriesOf(store.doc, keyOf, ['femur'])[5]?.progress.doubtful).toBe(false);
  });

  it('what a person found right is accepted, and no longer called doubtful', () => {
    const store = film(1);
    giveResult(store, place(0), { verdict: { word: 'doubtful', because: 'a part is hidden' } });
    const cell = () => cellOf(store.doc, place(0).frameId, 'femur');
    const progress = () => entriesOf(store.doc, keyOf, ['femur'])[0]!.progress;
    expect([isAccepted(cell(), markOf(store.doc, place(0))), progress().doubtful]).toEqual([false, true]);
    store.perform(toggleChecked(place(0)));
    expect([isAccepted(cell(), markOf(store.doc, place(0))), progress().doubtful, progress().check]).toEqual([true, false, 'yes']);
    giveResult(store, place(0), { candidates: [pose(2)], verdict: { word: 'doubtful', because: 'a part is hidden' } });
    expect([isAccepted(cell(), markOf(store.doc, place(0))), progress().doubtful]).toEqual([false, true]);
  });

  it('a verdict says what is doubtful; that a person took another candidate is no answer until it is checked', () => {
    const store = film(1);
    const doubtful = { word: 'doubtful', because: 'a part is hidden' } as const;
    const good = { misfit: 0.3, verdict: { word: 'good', because: 'it fits' } } as const;
    const candidates = [pose(1), { ...pose(2), judged: good }];
    const isDoubtful = () => entriesOf(store.doc, keyOf, ['femur'])[0]?.progress.doubtful;
    trace(store, place(0));
    giveResult(store, place(0), { candidates, verdict: doubtful });
    expect(isDoubtful()).toBe(true);
    giveResult(store, place(0), { candidates, verdict: doubtful, chosen: 1 });
    expect(isDoubtful()).toBe(true);
    giveResult(store, place(0), { candidates, decided: false, verdict: good.verdict });
    expect(isDoubtful()).toBe(false);
    giveResult(store, place(0), { candidates, verdict: good.verdict, chosen: 1 });
    expect(isDoubtful()).toBe(true);
  });

  it('goes to what has no pose, component by component and round, then to what nobody checked', () => {
    const store = film(3);
    for (const at of [place(0), place(2), place(0, 'tibia')]) {
      trace(store, at);
      giveResult(store, at);
    }
    const next = (index: number, component: ComponentName, step: 1 | -1 = 1) => {
      const found = nextTask(store.doc, keyOf, { index, component }, step);
      return found && `${found.filter} ${found.entry.index} ${found.entry.place.component}`;
    };
    expect(next(0, 'femur')).toBe('unfinished 1 femur');
    expect(next(1, 'femur')).toBe('unfinished 1 tibia');
    expect(next(2, 'tibia')).toBe('unfinished 1 femur');
    expect(next(1, 'tibia', -1)).toBe('unfinished 1 femur');
    for (const at of [place(1), place(1, 'tibia'), place(2, 'tibia')]) {
      trace(store, at);
      giveResult(store, at);
    }
    expect(next(0, 'femur')).toBe('unchecked 1 femur');
    for (const component of ['femur', 'tibia'] as const) {
      for (const frame of [0, 1, 2]) store.perform(toggleChecked(place(frame, component)));
    }
    expect(next(0, 'femur')).toBeNull();
  });

  it('a component that nobody works on is no task', () => {
    const store = film(2);
    for (const frame of [0, 1]) {
      trace(store, place(frame));
      giveResult(store, place(frame));
      store.perform(toggleChecked(place(frame)));
    }
    expect(nextTask(store.doc, keyOf, { index: 0, component: 'femur' }, 1)).toBeNull();
    expect(nextTask(store.doc, keyOf, { index: 0, component: 'tibia' }, 1)?.entry.place.component).toBe('tibia');
  });
});
