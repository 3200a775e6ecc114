import { describe, expect, it } from 'vitest';
import { addFrames, chooseCandidate, setModel, withCell } from '../../src/document/commands';
import { bare } from '../../src/document/hand_poses';
import { withKnownFilm } from '../../src/document/film';
import { toggleChecked } from '../../src/document/marks';
import { Store } from '../../src/document/store';
import type { Candidate, Posed, Result } from '../../src/document/types';
import { statesOf, trackedFiles } from '../../src/exchange/tracked';
import type { ComponentName } from '../../src/terms/component';

const POSE = { x: 1, y: 2, z: -1000, zRot: 3, xRot: 4, yRot: 5 };
/** As the core has it: row by row from the diagonal, here 11, 12 ... 16, 22, 23 ... 66. */
const UPPER = [11, 12, 13, 14, 15, 16, 22, 23, 24, 25, 26, 33, 34, 35, 36, 44, 45, 46, 55, 56, 66];
const WHOLE = [11, 12, 13, 14, 15, 16, 12, 22, 23, 24, 25, 26, 13, 23, 33, 34, 35, 36, 14, 24, 34, 44, 45, 46, 15, 25, 35, 45, 55, 56, 16, 26, 36, 46, 56, 66];
const FILM = [0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 5.5, 6];

function posed(covariance: readonly number[], change: Partial<Posed> = {}): Posed {
  const candidate: Candidate = { ...bare(POSE), residual: 0.2, deviations: { ...POSE, covariance } };
  return { kind: 'posed', from: 'film', origin: 'o', candidates: [candidate], chosen: 0, reason: null, decided: true, verdict: { word: 'good', because: 'it fits' }, ...change };
}

function film(): Store {
  const store = new Store();
  store.perform(addFrames(['a', 'b', 'c'].map((id) => ({ id, name: `${id}.png`, source: id, indexInSource: 0, width: 8, height: 8 }))));
  const set = (frameId: string, component: ComponentName, result: Result) => store.amend((doc) => withCell(doc, { frameId, component }, { outline: null, result, resultOf: null }));
  set('a', 'femur', posed([...UPPER, ...FILM]));
  set('a', 'tibia', posed(UPPER, { verdict: { word: 'doubtful', because: 'a rim, "perhaps"' }, doubt: 1.5 }));
  set('b', 'femur', posed([...UPPER, ...FILM.map(() => NaN)]));
  set('b', 'tibia', { kind: 'failed', origin: 'o', sentence: 'It is not there.' });
  store.perform(toggleChecked({ frameId: 'a', component: 'femur' }));
  return store;
}

describe('poses as the commands take them', () => {
  it('say of each cell that was looked at what became of it', () => {
    const [head, ...rows] = statesOf(film().doc).trimEnd().split('\r\n');
    expect(head).toMatch(/^frame,component,state,verdict,because,x_mm,.*,file,frame_of_file,method,checked$/);
    expect(rows).toEqual([
      '1,femur,fixed,good,it fits,1,2,-1000,3,4,5,1,2,-1000,3,4,5,0.2,,a.png,1,followed through the film,1',
      '1,tibia,doubtful,doubtful,"a rim, ""perhaps""",1,2,-1000,3,4,5,1,2,-1000,3,4,5,0.2,1.5,a.png,1,followed through the film,0',
      '2,femur,followed,good,it fits,1,2,-1000,3,4,5,1,2,-1000,3,4,5,0.2,,b.png,1,followed through the film,0',
      '2,tibia,no pose,none,It is not there.,,,,,,,,,,,,,,,b.png,1,,0',
    ]);
  });

  it('call fixed only what a person gave: by hand, from a file, by choice or by a check', () => {
    const state = (change: Partial<Posed>, isChecked = false) => {
      const store = film();
      const place = { frameId: 'c', component: 'femur' } as const;
      store.amend((doc) => withCell(doc, place, { outline: null, result: posed(UPPER, change), resultOf: null }));
      if (isChecked) store.perform(toggleChecked(place));
      return statesOf(store.doc).trimEnd().split('\r\n').at(-1)!.split(',').slice(2, 4).join(' ');
    };
    const ofClick = { from: 'outline', candidates: [bare(POSE), bare(POSE)] } as const;
    const verdict = { word: 'doubtful', because: 'so' } as const;
    expect(state(ofClick)).toBe('found good');
    expect(state(ofClick, true)).toBe('fixed good');
    expect(state({ ...ofClick, chosen: 1 })).toBe('fixed good');
    expect(state({ ...ofClick, verdict })).toBe('doubtful doubtful');
    expect(state({ from: 'hand' })).toBe('fixed good');
    expect(state({ from: 'file' })).toBe('fixed good');
    expect(state({})).toBe('followed good');
    expect(state({ from: 'file', verdict })).toBe('doubtful doubtful');
    expect(state({ verdict }, true)).toBe('fixed good');
    expect(state({ from: 'file', verdict: null })).toBe('fixed none');
    expect(state({ from: 'file', verdict: null }, true)).toBe('fixed good');
  });

  it('give a reason with every verdict, also where nothing was held against the frame', () => {
    const because = (change: Partial<Posed>, isChecked = false) => {
      const store = film();
      const place = { frameId: 'c', component: 'femur' } as const;
      store.amend((doc) => withCell(doc, place, { outline: null, result: posed(UPPER, change), resultOf: null }));
      if (isChecked) store.perform(toggleChecked(place));
      return statesOf(store.doc).trimEnd().split('\r\n').at(-1)!.split(',')[4];
    };
    expect(because({ from: 'file', verdict: null })).toBe('it was not held against the frame');
    expect(because({ from: 'file', verdict: null }, true)).toBe('a person fixed the pose');
    expect(because({ from: 'file' })).toBe('it fits');
    expect(because({ verdict: { word: 'doubtful', because: 'so' } }, true)).toBe('a person checked it; it was doubtful: so');
  });

  it('say of a pose that a person took instead of the followed one what that leaves, and that the other was doubtful', () => {
    const row = (residual: number | null, from: 'film' | 'outline') => {
      const store = film();
      const verdict = { word: 'doubtful', because: 'jump: it lies off the way' } as const;
      const result = posed(UPPER, { from, candidates: [bare(POSE), { ...bare(POSE), residual }], verdict });
      const place = { frameId: 'c', component: 'tibia' } as const;
      store.amend((doc) => withCell(doc, place, { outline: null, result, resultOf: null }));
      store.perform(chooseCandidate(place, 1));
      return statesOf(store.doc).trimEnd().split('\r\n').at(-1)!.split(/,(?! )/).slice(2, 5);
    };
    const open = ['fixed', 'doubtful', '"it was taken by hand in place of the first, which was doubtful: jump: it lies off the way"'];
    expect(row(1.9, 'film')).toEqual(open);
    expect(row(null, 'film')).toEqual(open);
    expect(row(2.6, 'film')).toEqual(['doubtful', 'doubtful', '"a person fixed the pose, and it leaves 2.6 px beside the edges"']);
    expect(row(0.5, 'outline')).toEqual(['fixed', 'good', 'a person fixed the pose']);
  });

  it('have whole covariances, and what of them is the film\u2019s where that is known', () => {
    const files = Object.fromEntries(trackedFiles(film().doc, { femur: 'F', tibia: 'T' }));
    expect(Object.keys(files)).toEqual(['femur.jts', 'femur.covariances.csv', 'tibia.jts', 'tibia.covariances.csv', 'track.csv', 'film.csv']);
    const rows = (name: string) => files[name]!.trimEnd().split('\r\n').slice(1).map((row) => row.split(',').map(Number));
    expect(rows('femur.covariances.csv')).toEqual([[1, ...WHOLE, ...FILM], [2, ...WHOLE]]);
    expect(rows('tibia.covariances.csv')).toEqual([[1, ...WHOLE]]);
    expect(files['tibia.jts']).toBe('T');
  });

  it('have the constants of the film, with deviations where they were estimated', () => {
    const store = film();
    store.perform(setModel('femur', { name: 'f', sha256: 'f' }));
    store.perform(setModel('tibia', { name: 't', sha256: 't' }));
    const numbers = [0.01, 1.5, 0.2, 4, 0, 0, 0, 9, 0, 0, 0, 16, 0.8, 2.5, 60, 0.3];
    const models = { femur: { of: 'f', numbers }, tibia: { of: 't', numbers: [0.01, 1.5, 0.3, ...Array(9).fill(0), 0.8, 2.5, 60, 0.3, 2] } };
    store.amend((doc) => withKnownFilm(doc, { words: '', stated: doc.film.stated, blur: 1.5, curved: 1, profiles: 9, models }));
    const rows = Object.fromEntries(trackedFiles(store.doc, { femur: 'F', tibia: 'T' }))['film.csv']!.split('\r\n');
    expect(rows.slice(1)).toEqual(['femur,0.01,2,1.5,4.5,0.2,0.8,0.8,2.5,1', 'tibia,0.01,0,3,0,0.3,0,0.8,5,2', '']);
  });
});
