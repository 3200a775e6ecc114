import { describe, expect, it } from 'vitest';
import { Cells } from '../../src/document/cells';
import { decodeBase64, encodeBase64, readSession, writeSession, type Session } from '../../src/document/session/session';
import { cellKey, EMPTY_DOC, type Cell, type Doc, type Outline } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';

const outline: Outline = { points: [framePoint(1.25, 2), framePoint(1 / 3, 1e-7), framePoint(1023.999, 5)], closed: true, unknownSides: [0, 2], laidBy: 'mixed' };
const pose = { x: 4.605862, y: -17.13854, z: -1083.741, zRot: 7.91024, xRot: 5.66783, yRot: -1.187261 };

const deviations = { x: 0.021, y: 0.02, z: 0.31, zRot: 0.03, xRot: 0.05, yRot: 0.06, covariance: [1e-7, 1 / 3, -2.5] };

const posed: Cell = {
  outline,
  result: {
    kind: 'posed',
    from: 'outline',
    origin: 'k',
    candidates: [{ pose, unmatched: 625, drawn: 41, residual: 0.21, deviations, judged: { misfit: 0.3, verdict: { word: 'good', because: 'it fits' } }, support: 0.9 }],
    chosen: 0,
    reason: 'The only pose found.',
    decided: true,
    verdict: { word: 'doubtful', because: 'a part is hidden' },
    onFrame: { film: [0.026, 0.8, 0.7] },
  },
  resultOf: outline,
};
const stale: Cell = { outline, result: { kind: 'failed', origin: 'k', sentence: 'crosses itself' }, resultOf: null };
const loaded: Cell = {
  outline: null,
  result: {
    kind: 'posed',
    from: 'file',
    origin: 'fem.jts',
    candidates: [{ pose, unmatched: null, drawn: null, residual: null, deviations: null, judged: null }],
    chosen: 0,
    reason: null,
    decided: true,
    verdict: null,
  },
  resultOf: null,
};

const doc: Doc = {
  ...EMPTY_DOC,
  name: 'Knie "7" – süß',
  side: 'left',
  frames: [{ id: 'ab:0', name: 'film.tif #1', source: 'ab', indexInSource: 0, width: 1024, height: 1000 }],
  calibration: { name: 'c.txt', text: 'JT_INTCALIB\n1198\n0\n0\n0.373\n' },
  components: {
    ...EMPTY_DOC.components,
    tibia: { ...EMPTY_DOC.components.tibia, axes: { directions: [[0, 0, 1], [0, -1, 0], [1, 0, 0]], from: 'shape', told: 'not the front' } },
  },
  cells: Cells.from<Cell>([[cellKey('ab:0', 'femur'), posed], [cellKey('ab:0', 'tibia'), stale], ['x/femur', loaded]]),
  window: { centre: 2000, width: 4095 },
  rate: 7.5,
  unread: ['0002.tif'],
  kneeDoubt: { models: '["femur","tibia"]', sentence: 'are the pictures mirrored?' },
  film: { stated: { display: 'linear', blur: 1.2, constants: { curvature: 0.02, blur: 1, attenuation: { femur: 0.7, tibia: null } } }, known: null },
  marks: { [cellKey('ab:0', 'tibia')]: { checked: '1-2', flagged: true, note: 'Zement "am" Rand' } },
};

const bytes = Uint8Array.from({ length: 70_001 }, (_, i) => (i * 31) & 255);
const session: Session = {
  doc,
  view: { frameIndex: 0, component: 'tibia', overlayOpacity: 0.35 },
  audit: null,
  files: [
    { name: 'film.tif', sha256: 'ab', bytes },
    { name: 'fem.stl', sha256: 'cd', bytes: null },
  ],
};

const written = () => writeSession(session, 'fluoropose 0', new Date(0)).join('');
/** As somebody else or an older page writes it. */
const bare = () => written().replace(/"checksum":\d+,/, '');

describe('session', () => {
  it('loses nothing', () => {
    expect(readSession(written())).toEqual(session);
  });

  it('reads what was saved before whole covariances and the speed of the film were kept', () => {
    const old = bare().replace(/,"covariance":\[[^\]]*\]/g, '').replace(',"rate":7.5', '');
    expect(old).not.toMatch(/covariance|"rate"/);
    const { rate, cells } = readSession(old).doc;
    const { result } = cells.at('ab:0', 'femur')!;
    const { covariance: _, ...six } = deviations;
    expect([rate, result?.kind === 'posed' && result.candidates[0]?.deviations]).toEqual([null, six]);
  });

  it('reads candidates that were saved before poses were refined', () => {
    const old = bare()
      .replace(/,"judged":(null|\{.*?\}\})(,"support":[\d.]+)?/g, '')
      .replace(/,"residual":[^{}]*(\{[^{}]*\}|null)?(?=\})/g, '');
    expect(old).not.toMatch(/residual|deviations|judged/);
    const result = readSession(old).doc.cells.at('ab:0', 'femur')?.result;
    expect(result?.kind === 'posed' && result.candidates[0]).toMatchObject({ pose, residual: null, deviations: null, judged: null });
  });

  it('reads outlines and choices that were saved before sides could be marked and choices had reasons', () => {
    const old = bare().replace(/,"(unknownSides|laidBy|reason|decided)":(\[[^\]]*\]|"[^"]*"|\w+)/g, '');
    expect(old).not.toMatch(/unknownSides|laidBy|reason|decided/);
    const { cells } = readSession(old).doc;
    const cell = cells.at('ab:0', 'femur');
    // Poses on the frame came of one click alone then, with the outline that they have.
    expect(cell?.outline).toEqual({ ...outline, unknownSides: [], laidBy: 'click' });
    const { laidBy: _, ...byHand } = outline;
    expect(cells.at('ab:0', 'tibia')?.outline).toEqual({ ...byHand, unknownSides: [] });
    expect(cell?.result).toMatchObject({ reason: null, decided: false, chosen: 0 });
  });

  it('knows which results belong to their outlines', () => {
    const { cells } = readSession(written()).doc;
    const [first, second] = [cells.at('ab:0', 'femur'), cells.at('ab:0', 'tibia')];
    expect(first?.resultOf).toBe(first?.outline);
    expect(second?.resultOf).toBeNull();
  });

  it('names kind, version and program', () => {
    expect(JSON.parse(written())).toMatchObject({ kind: 'fluoropose-session', version: 5, program: 'fluoropose 0' });
  });

  it('refuses a file that is cut at any of many places', () => {
    const text = written();
    for (let length = 0; length < text.length - 2; length += 997) {
      expect(() => readSession(text.slice(0, length))).toThrow(/cut short|damaged|not a JSON/);
    }
  });

  it.each([
    ['"version":5', '"version":6', /version 6.*newer page/],
    ['"told":"not the front"', '"told":"half"', /axes\.told should be "all" or "not the front"/],
    ['"all directions",', '"some directions",', /librarySpec\.views should be "all directions" or "window"/],
    ['"word":"doubtful"', '"word":"none"', /verdict\.word should be "good" or "doubtful"/],
    ['fluoropose-session', 'something', /not a fluoropose session/],
    ['"width":1024', '"width":"1024"', /document\.frames\[0\]\.width should be a finite number/],
    ['"closed":true', '"closed":1', /closed should be true or false but is 1/],
    ['[1.25,2]', '[1.25]', /points\[0\] should be a pair/],
    ['"unknownSides":[0,2]', '"unknownSides":[0,3]', /unknownSides names side 3 of 3/],
    ['"centre":2000', '"center":2000', /document\.window\.centre should be a finite number but is missing/],
    ['"tibia","overlayOpacity"', '"patella","overlayOpacity"', /"femur" or "tibia"/],
  ])('says where it is wrong: %s as %s', (from, to, sentence) => {
    const text = written();
    expect(text).toContain(from);
    expect(() => readSession(text.replace(from, to))).toThrow(sentence);
  });
});

describe('base64', () => {
  it.each([0, 1, 2, 3, 24_575, 24_576, 24_577])('round trip of %i bytes', (length) => {
    const part = bytes.subarray(0, length);
    expect(decodeBase64(encodeBase64(part), 'x')).toEqual(part);
  });

  it('names the file that is damaged', () => {
    expect(() => decodeBase64('?', 'files[0] (a.png)')).toThrow(/a\.png/);
  });
});
