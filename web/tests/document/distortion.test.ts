import { describe, expect, it } from 'vitest';
import { Cells } from '../../src/document/cells';
import {
  type Distortion,
  distortionKey,
  distortionOf,
  fits,
  numbersOf,
  readDistortionFile,
  writeDistortionFile,
} from '../../src/document/distortion';
import { withCell } from '../../src/document/commands';
import { setDistortion } from '../../src/document/set_distortion';
import { perform, startHistory, undo } from '../../src/document/history';
import { readSession, writeSession } from '../../src/document/session/session';
import { cellKey, EMPTY_DOC, type Doc } from '../../src/document/types';
import { cameraOf, poseKey } from '../../src/results/keys';
import { framePoint } from '../../src/geometry/points';

const QUALITY = { beads: 200, dropped: 1, before: 3.2, after: 0.04, leftOut: [0.3, 0.28, 0.05], largestShift: 11 };

/** Moves everything by so many columns. */
function shift(columns: number, appliesTo: Distortion['appliesTo'] = 'frames'): Distortion {
  const column = [columns / 100, 1, ...Array<number>(19).fill(0)];
  const row = [0, 0, 1, ...Array<number>(18).fill(0)];
  return { name: 'plate.png', appliesTo, order: 3, width: 400, height: 300, centre: [200, 150], scale: 100, column, row, quality: QUALITY };
}

const move = (columns: number) => (points: Float64Array) => points.map((value, at) => (at % 2 === 0 ? value + columns : value));

function docOf(size = { width: 400, height: 300 }): Doc {
  const outline = { points: [framePoint(10, 20), framePoint(50, 20), framePoint(30, 60)], closed: true, unknownSides: [1] };
  const frame = { id: 'a:0', name: 'a.png', source: 'a', indexInSource: 0, ...size };
  const calibration = { name: 'c', text: 'JT_INTCALIB\n1000\n0\n0\n0.3\n' };
  return { ...EMPTY_DOC, frames: [frame], calibration, cells: Cells.from([[cellKey('a:0', 'femur'), { outline, result: null, resultOf: null }]]) };
}

const columns = (doc: Doc) => doc.cells.at('a:0', 'femur')?.outline?.points.map((point) => point.column);

describe('a correction of distortion', () => {
  it('is the numbers of the core, and back', () => {
    const distortion = shift(7);
    const numbers = numbersOf(distortion);
    expect(numbers).toHaveLength(48);
    expect(distortionOf(numbers, distortion)).toEqual(distortion);
    expect(distortionKey(shift(7))).toBe(distortionKey(distortion));
    expect(distortionKey(shift(7, 'outlines'))).not.toBe(distortionKey(distortion));
  });

  it('is written to a file and read back', () => {
    expect(readDistortionFile(writeDistortionFile(shift(3)))).toEqual(shift(3));
  });

  it.each([
    ['{', /cut short or damaged/],
    ['{"kind":"another","version":1}', /its kind is "another"/],
    ['{"kind":"fluoropose-distortion","version":9}', /version 9/],
    [writeDistortionFile({ ...shift(3), column: [1, 2] }), /file\.column should hold 21 numbers but holds 2/],
  ])('says what is wrong with a file: %#', (json, sentence) => {
    expect(() => readDistortionFile(json)).toThrow(sentence);
  });

  it('takes outlines along with the frames, and undo brings them back', () => {
    const start = startHistory(docOf());
    const applied = perform(start, setDistortion(shift(5), null, move(5)));
    expect(columns(applied.present)).toEqual([15, 55, 35]);
    expect(applied.present.cells.at('a:0', 'femur')?.outline?.unknownSides).toEqual([1]);
    const other = perform(applied, setDistortion(shift(9), move(-5), move(9)));
    expect(columns(other.present)).toEqual([19, 59, 39]);
    const away = perform(other, setDistortion(null, move(-9), null));
    expect(columns(away.present)).toEqual([10, 50, 30]);
    expect(undo(undo(undo(away))).present).toEqual(docOf());
  });

  it('leaves outlines where they are when it is for outlines alone, or for frames of another size', () => {
    const forOutlines = setDistortion(shift(5, 'outlines'), null, null).apply(docOf());
    expect(columns(forOutlines)).toEqual([10, 50, 30]);
    const elsewhere = setDistortion(shift(5), null, move(5)).apply(docOf({ width: 500, height: 300 }));
    expect(columns(elsewhere)).toEqual([10, 50, 30]);
  });

  it('drops what was followed on frames that look otherwise, and on no others', () => {
    const result = { kind: 'posed', from: 'film', origin: 'followed from frame 1', candidates: [], chosen: 0, reason: null, decided: true, verdict: null } as const;
    const followed = (doc: Doc) => withCell(doc, { frameId: 'a:0', component: 'tibia' }, { outline: null, result, resultOf: null });
    const left = (doc: Doc) => setDistortion(shift(5), null, move(5)).apply(doc).cells.at('a:0', 'tibia')?.result ?? null;
    expect(left(followed(docOf()))).toBeNull();
    expect(left(followed(docOf({ width: 500, height: 300 })))).toEqual(result);
  });

  it('makes poses outdated, and goes to the worker with outlines that are to be undistorted', () => {
    const doc = { ...docOf(), components: { ...EMPTY_DOC.components, femur: { ...EMPTY_DOC.components.femur, model: { name: 'm', sha256: 'm' } } } };
    const frame = doc.frames[0]!;
    const corrected = { ...doc, distortion: shift(5) };
    const outlines = { ...doc, distortion: shift(5, 'outlines') };
    const keys = [doc, corrected, outlines].map((each) => poseKey(each, 'femur', frame));
    expect(new Set(keys).size).toBe(3);
    expect(cameraOf(corrected, frame)?.distortion).toBeUndefined();
    expect(cameraOf(outlines, frame)?.distortion?.numbers).toEqual(numbersOf(shift(5)));
    expect(cameraOf(outlines, frame)?.distortion).toBe(cameraOf(outlines, frame)?.distortion);
    expect(fits(outlines.distortion, { width: 401, height: 300 })).toBe(false);
    expect(cameraOf(outlines, { ...frame, width: 401 })?.distortion).toBeUndefined();
  });

  it('is kept in a session; one from before it has none', () => {
    const doc = { ...docOf(), distortion: shift(2) };
    const view = { frameIndex: 0, component: 'femur', overlayOpacity: 0.5 } as const;
    const json = writeSession({ doc, view, files: [], audit: null }, 'test', new Date(0)).join('');
    expect(readSession(json).doc.distortion).toEqual(shift(2));
    const before = JSON.parse(json) as { checksum?: number; document: { distortion?: unknown } };
    delete before.checksum;
    delete before.document.distortion;
    expect(readSession(JSON.stringify(before)).doc.distortion).toBeNull();
  });
});
