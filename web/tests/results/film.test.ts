import { describe, expect, it } from 'vitest';
import { filmNumbers, stateFilm } from '../../src/document/film';
import { toggleChecked } from '../../src/document/marks';
import { NOTHING_STATED, cellKey, type Candidate, type Doc, EMPTY_DOC, type KnownFilm, type Outline, type Posed, type Verdict, verdictOf } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import { rotated } from '../../src/geometry/pose_motion';
import { filmMissed, corrected, isNear, isNews, isSamePlace, misfitsBeside, needsCorrection, settled, verdictAfter, witnesses } from '../../src/results/film';
import { poseKey } from '../../src/results/keys';

const GOOD: Verdict = { word: 'good', because: 'it fits' };
const RIVAL: Verdict = { word: 'doubtful', because: 'another pose fits as well' };
const OUTLINE: Outline = { points: [framePoint(1, 1), framePoint(5, 1), framePoint(3, 6)], closed: true, unknownSides: [] };
const ORIGIN = [0, 0, 0] as const;
const K = [0.026, 0.8, 0.7];
const COVARIANCE = [1e-6, 0, 0, 0, 0.0025, 0, 0, 0, 0.01];

function candidate(misfit: number, verdict = GOOD): Candidate {
  return { pose: { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 }, unmatched: null, drawn: null, residual: misfit, deviations: null, judged: { misfit, verdict } };
}

function known(numbers: readonly number[], of = 'femur model'): KnownFilm {
  return { words: 'w', stated: NOTHING_STATED, blur: 0.8, curved: 2, profiles: 90, models: { femur: { of, numbers }, tibia: null } };
}

const BARE: Doc = {
  ...EMPTY_DOC,
  frames: ['a', 'b'].map((id) => ({ id, name: id, source: id, indexInSource: 0, width: 8, height: 8 })),
  calibration: { name: 'c', text: 'c' },
  components: { ...EMPTY_DOC.components, femur: { ...EMPTY_DOC.components.femur, model: { name: 'f.stl', sha256: 'femur model' } } },
};

function posed(doc: Doc, frame: string, part: Partial<Posed> = {}): Doc {
  const origin = poseKey(doc, 'femur', doc.frames[0]!)!;
  const result: Posed = { kind: 'posed', from: 'outline', origin, candidates: [candidate(0.2)], chosen: 0, reason: null, decided: true, verdict: GOOD, onFrame: { film: null }, ...part };
  return { ...doc, cells: doc.cells.with(frame, 'femur', { outline: OUTLINE, result, resultOf: OUTLINE }) };
}

const told = (doc: Doc, numbers = [...K, ...COVARIANCE]): Doc => ({ ...doc, film: { ...doc.film, known: known(numbers) } });

describe('who tells of the film', () => {
  const names = (doc: Doc) => witnesses(doc, () => true).map(({ frameId }) => frameId);

  it('refined poses and those of files do; what was only placed by hand, is outdated or of another outline does not', () => {
    expect(names(posed(posed(BARE, 'a'), 'b'))).toEqual(['a', 'b']);
    const placed = [{ ...candidate(1), residual: null }];
    expect(names(posed(BARE, 'a', { from: 'hand', candidates: placed }))).toEqual([]);
    expect(names(posed(BARE, 'a', { from: 'file', candidates: placed }))).toEqual(['a']);
    expect(names(posed(BARE, 'a', { origin: 'another library' }))).toEqual([]);
    expect(witnesses(posed(BARE, 'a'), () => false)).toEqual([]);
    expect(names(posed(BARE, 'a', { from: 'film' }))).toEqual([]);
  });

  it('doubtful poses do where nothing better does', () => {
    const doubtful = posed(BARE, 'a', { verdict: RIVAL });
    expect(names(doubtful)).toEqual(['a']);
    expect(names(posed(doubtful, 'b'))).toEqual(['b']);
  });

  it('are sixteen of a component, and those that were asked stay', () => {
    const ids = Array.from({ length: 20 }, (_, index) => `f${index}`);
    const [frame] = BARE.frames;
    const many = ids.reduce<Doc>((doc, id) => posed(doc, id), { ...BARE, frames: ids.map((id) => ({ ...frame!, id })) });
    expect(names(many)).toEqual(ids.slice(0, 16));
    const last = cellKey('f19', 'femur');
    expect(witnesses(many, () => true, (key) => key === last).map(({ frameId }) => frameId)).toEqual(['f19', ...ids.slice(0, 15)]);
  });

  it('a pose is asked again where it lies elsewhere', () => {
    const { pose } = candidate(1);
    expect(isNear(pose, { ...pose, z: pose.z - 1.9 }, ORIGIN)).toBe(true);
    expect(isNear(pose, { ...pose, x: 2 }, ORIGIN)).toBe(false);
    expect(isNear({ ...pose, x: NaN }, pose, ORIGIN)).toBe(false);
  });

  it('lies elsewhere whatever the axes and the origin of the model are', () => {
    const upright = { x: 1, y: 2, z: -1000, zRot: 30, xRot: 89.9, yRot: 10 };
    const locks = { x: false, y: false, z: false, zRot: false, xRot: false, yRot: false };
    // The two turn about nearly the same axis there, and take each other back.
    expect(isSamePlace(upright, { ...upright, zRot: 50, yRot: -10 }, ORIGIN)).toBe(true);
    const far = [0, 0, 400] as const;
    const turned = rotated(upright, [0, 0, 2], far, locks);
    expect(isSamePlace(upright, turned, far)).toBe(true);
    expect(isSamePlace(upright, turned, ORIGIN)).toBe(false);
    expect(isSamePlace(upright, rotated(upright, [0, 0, 4], far, locks), far)).toBe(false);
  });
});

describe('news of the film', () => {
  const before = known([...K, ...COVARIANCE]);

  it('is what moves by a sixth of a standard deviation or more, is much surer, of another model, or stated otherwise', () => {
    expect(isNews(before, known([0.0261, 0.805, 0.705, ...COVARIANCE]))).toBe(false);
    expect(isNews(before, known([0.0263, 0.8, 0.7, ...COVARIANCE]))).toBe(true);
    expect(isNews(before, known([0.026, 0.8, 0.72, ...COVARIANCE]))).toBe(true);
    expect(isNews(before, known([...K, 1e-7, ...COVARIANCE.slice(1)]))).toBe(true);
    expect(isNews(before, known([...K, ...COVARIANCE], 'another'))).toBe(true);
    expect(isNews(before, { ...before, stated: { ...NOTHING_STATED, display: 'linear' } })).toBe(true);
    expect(isNews(before, { ...before, models: { ...before.models, tibia: before.models.femur } })).toBe(true);
  });

  it('is the first and the last', () => {
    expect(isNews(null, before)).toBe(true);
    expect(isNews(before, null)).toBe(true);
    expect(isNews(null, null)).toBe(false);
  });
});

describe('what a pose that stays does not know of its film', () => {
  /** Curvature, blur and attenuation with deviations of 0.001, and of 10 % of the others. */
  const now = [0.01, 1.5, 0.2, 1e-6, 0, 0, 0, 0.01, 0, 0, 0, 0.01];

  it('is all of it, where nothing was known, and nothing where the estimate moved by less than it is sure of', () => {
    expect(filmMissed(null, now)).toBe('all');
    expect(filmMissed([0.0104, 1.55, 0.19], now)).toBeNull();
    expect(filmMissed([0.0104, 1.55, 0.19], null)).toBeNull();
  });

  it('is other constants, where they lie further away, or were stated', () => {
    expect(filmMissed([0.012, 1.5, 0.2], now)).toBe('others');
    expect(filmMissed([0.01, 1.9, 0.2], now)).toBe('others');
    expect(filmMissed([0.01, 1.51, 0.2], [0.01, 1.5, 0.2])).toBe('others');
    expect(filmMissed([0.01, 1.5, 0.2], [0.01, 1.5, 0.2])).toBeNull();
  });
});

describe('what a known film changes', () => {
  const frame = BARE.frames[0]!;

  it('poses found on the frame with other constants, and no others', () => {
    const open = told(posed(BARE, 'a'));
    expect(needsCorrection(open, 'femur', frame)?.result.onFrame).toEqual({ film: null });
    expect(needsCorrection(posed(BARE, 'a'), 'femur', frame)).toBeNull();
    expect(needsCorrection(told(posed(BARE, 'a', { onFrame: { film: K } })), 'femur', frame)).toBeNull();
    expect(needsCorrection(told(posed(BARE, 'a', { from: 'hand' })), 'femur', frame)).toBeNull();
    const { onFrame: _, ...traced } = open.cells.at('a', 'femur')!.result as Posed;
    expect(needsCorrection({ ...open, cells: open.cells.with('a', 'femur', { outline: OUTLINE, result: traced, resultOf: OUTLINE }) }, 'femur', frame)).toBeNull();
  });

  it('nothing that a person checked', () => {
    const checked = toggleChecked({ frameId: 'a', component: 'femur' }).apply(posed(BARE, 'a'));
    expect(needsCorrection(told(checked), 'femur', frame)).toBeNull();
  });

  it('nothing of another model', () => {
    expect(filmNumbers(told(BARE), 'femur')).toHaveLength(12);
    const other = { ...BARE.components.femur, model: { name: 'g.stl', sha256: 'other' } };
    expect(filmNumbers({ ...told(BARE), components: { ...BARE.components, femur: other } }, 'femur')).toBeNull();
  });

  it('each of several poses by itself: what they leave on a known film tells which is likelier', () => {
    const [first, rival] = [candidate(0.6), candidate(0.75)];
    const after = { ...candidate(0.3), pose: { ...first.pose, z: -985 } };
    expect(corrected(first, after).judged?.misfit).toBeCloseTo(0.3);
    expect(corrected(rival, candidate(0.2)).judged?.misfit).toBeCloseTo(0.2);
    expect(corrected(first, after).pose.z).toBe(-985);
  });

  it('the verdict is that of the corrected pose, and a rival that was open stays open', () => {
    const before = (posed(BARE, 'a', { verdict: RIVAL }).cells.at('a', 'femur')!.result as Posed);
    expect(verdictAfter(before, [candidate(0.3)])).toEqual(RIVAL);
    const weak: Verdict = { word: 'doubtful', because: 'little of it is met' };
    expect(verdictAfter(before, [candidate(0.3, weak)])).toEqual(weak);
    expect(verdictAfter({ ...before, verdict: GOOD }, [candidate(0.3)])).toEqual(GOOD);
  });

  it('a pose that leaves clearly more than another is not good', () => {
    const before = posed(BARE, 'a', { verdict: GOOD }).cells.at('a', 'femur')!.result as Posed;
    expect(verdictAfter(before, [candidate(0.44), candidate(0.13)])?.word).toBe('doubtful');
    expect(verdictAfter(before, [candidate(0.13), candidate(0.44)])).toEqual(GOOD);
    expect(verdictAfter(before, [candidate(0.5), candidate(0.45)])).toEqual(GOOD);
  });

  describe('mirror images that nobody had looked at', () => {
    const before = (verdict: Verdict) => posed(BARE, 'a', { verdict }).cells.at('a', 'femur')!.result as Posed;
    const own = candidate(0.2);

    it('one that leaves clearly less takes the place of the pose', () => {
      const better = candidate(0.1);
      expect(settled(before(GOOD), [own], [better])).toEqual({ candidates: [better, own], chosen: 0, decided: true, verdict: GOOD, reason: 'On this film it leaves 0.10 px, its mirror image 0.20 px.' });
    });

    it('but not of one that a person chose', () => {
      const [first, better] = [candidate(0.3), candidate(0.1)];
      const after = settled({ ...before(GOOD), chosen: 1 }, [first, own], [better]);
      expect(after).toMatchObject({ candidates: [first, own, better], chosen: 1, decided: false, verdict: { word: 'doubtful' } });
    });

    it('one that leaves about as much makes the pose doubtful', () => {
      const other = candidate(0.25);
      expect(settled(before(GOOD), [own], [other])).toMatchObject({ candidates: [own, other], chosen: 0, decided: false, verdict: { word: 'doubtful' } });
    });

    it('and the reason no longer says that there is only one', () => {
      const alone: Posed = { ...before(GOOD), reason: 'The only pose found.' };
      const reasons = [0.1, 0.25, 0.3].map((misfit) => settled(alone, [own], [candidate(misfit)]).reason);
      expect(reasons).toHaveLength(3);
      for (const reason of reasons) expect(reason).toMatch(/its mirror image/);
      expect(reasons[1]).toMatch(/^Not decided/);
      expect(settled(alone, [own], []).reason).toBe('The only pose found.');
      const open: Verdict = { word: 'doubtful', because: 'another pose, 0 mm away, fits as well' };
      expect(settled({ ...before(open), decided: false, reason: 'Undecided' }, [own], [])).toMatchObject({ decided: true, reason: null, verdict: GOOD });
      expect(settled({ ...alone, chosen: 1 }, [candidate(0.3), own], [candidate(0.25)]).reason).toMatch(/^Not decided/);
    });

    it('one that its frame does not bear out is doubtful, also beside others of which that is so', () => {
      const unmet = { ...candidate(0.2), judged: null };
      const doubtful = { word: 'doubtful', because: expect.stringContaining("another frame's mask") as string };
      for (const more of [[], [unmet]]) {
        const after = settled({ ...before(GOOD), reason: 'The only pose found.' }, [unmet], more);
        expect(after).toMatchObject({ chosen: 0, reason: 'The only pose found.', verdict: doubtful });
      }
      expect(settled({ ...before(GOOD), chosen: 1 }, [candidate(0.1), unmet], []).verdict).toEqual(doubtful);
      const chosen: Posed = { ...before(GOOD), candidates: [candidate(0.1), unmet], chosen: 1, onFrame: { film: K } };
      expect(verdictOf(chosen)).toEqual(doubtful);
      // One that the frame bears out takes its place.
      const met = candidate(0.4);
      expect(settled(before(GOOD), [unmet], [met])).toMatchObject({ candidates: [met, unmet], chosen: 0, verdict: GOOD });
    });

    it('one that leaves more is a candidate, and no more than that', () => {
      const worse = candidate(0.3);
      expect(settled(before(GOOD), [own], [worse])).toEqual({ candidates: [own, worse], chosen: 0, decided: true, verdict: GOOD, reason: 'On this film it leaves 0.20 px, its mirror image 0.30 px.' });
    });
  });

  it('with what is usual beside it: other frames of the component, and other components', () => {
    const found = posed(posed(BARE, 'a', { onFrame: { film: K } }), 'b', { onFrame: { film: K } });
    const { own, others } = misfitsBeside(found, { frameId: 'a', component: 'femur' });
    expect([own.length, others]).toEqual([1, []]);
    expect(misfitsBeside(found, { frameId: 'a', component: 'tibia' }).others).toHaveLength(2);
    expect(misfitsBeside(posed(BARE, 'b'), { frameId: 'a', component: 'femur' }).own).toEqual([]);
  });
});

it('what a person states is one step back, and leaves what is known until it is asked again', () => {
  const stated = stateFilm({ ...NOTHING_STATED, display: 'linear' }).apply(told(BARE));
  expect(stated.film.stated.display).toBe('linear');
  expect(stated.film.known).not.toBeNull();
});
