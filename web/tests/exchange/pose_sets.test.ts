import { describe, expect, it } from 'vitest';
import { setModel } from '../../src/document/commands';
import { Store } from '../../src/document/store';
import { atHand, componentFor } from '../../src/exchange/guess';
import { setsToAsk, sortedPoses } from '../../src/exchange/pose_sets';

const file = (name: string, path?: string) => ({ name, blob: new Blob(), ...(path !== undefined && { path }) });

describe('files of poses', () => {
  const { state } = new Store();

  it('one of each component is taken as it is', () => {
    const sorted = sortedPoses(state, [file('tib.jts'), file('fem.jts')]);
    expect(sorted.clear.map(({ name }) => name)).toEqual(['fem.jts', 'tib.jts']);
    expect(setsToAsk(sorted, () => undefined)).toBeNull();
  });

  it('of several of one component none is, before a person says which', () => {
    const opened: string[] = [];
    const sorted = sortedPoses(state, [file('fem.jts', '/a/fem.jts'), file('fem.jts', '/b/fem.jts'), file('tib.jts')]);
    expect(sorted.clear.map(({ name }) => name)).toEqual(['tib.jts']);
    const sets = setsToAsk(sorted, (files) => opened.push(...files.map(({ path }) => path ?? '')))!;
    expect(sets.names).toEqual({ femur: ['a/fem.jts', 'b/fem.jts'], tibia: [] });
    sets.take({ femur: 1, tibia: 0 });
    sets.take({ femur: null, tibia: 0 });
    expect(opened).toEqual(['/b/fem.jts']);
  });
});

describe('which component a model is for', () => {
  const { state } = new Store();
  const free = () => false;

  it('is what a person, a name or its shape says, in this order', () => {
    expect(componentFor(state, { name: 'implant.stl' }, free, 'tibia')).toBe('tibia');
    expect(componentFor(state, { name: 'implant.stl' }, free, null)).toBe('femur');
    expect(componentFor(state, { name: 'tibia.stl' }, free, 'femur')).toBe('tibia');
    expect(componentFor(state, { name: 'tibia.stl', component: 'femur' }, free, 'tibia')).toBe('femur');
  });
});

describe('which component is worked on after files were opened', () => {
  it('is the selected one, unless the other one alone has a model', () => {
    const store = new Store();
    expect(atHand(store.doc, 'femur')).toBe('femur');
    store.perform(setModel('tibia', { name: 'tray.stl', sha256: 't' }));
    expect(atHand(store.doc, 'femur')).toBe('tibia');
    expect(atHand(store.doc, 'tibia')).toBe('tibia');
    store.perform(setModel('femur', { name: 'femur.stl', sha256: 'f' }));
    expect(atHand(store.doc, 'femur')).toBe('femur');
  });
});
