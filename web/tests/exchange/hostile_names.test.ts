import { describe, expect, it } from 'vitest';
import { Cells } from '../../src/document/cells';
import { poseTable, tableOf } from '../../src/document/session/table';
import { cellKey, EMPTY_DOC, type Doc, type Outline } from '../../src/document/types';
import { fileStem, sessionName } from '../../src/terms/file_name';
import { masksOf } from '../../src/exchange/exporter';
import { framePoint } from '../../src/geometry/points';

const HOSTILE = [
  '../../../etc/passwd',
  '..\\..\\windows\\system.ini',
  '/absolute/name.png',
  'C:\\name.png',
  '..',
  '.',
  '',
  '   ',
  '.hidden',
  'CON',
  'nul.png',
  'com1.tif #2',
  'LPT¹.png',
  'a\0b\u0007c.png',
  'line\r\nbreak.png',
  '\u202egnp.exe',
  '\u2066isolated\u2069.png',
  '<img src=x onerror=alert(1)>.png',
  '"><script>alert(1)</script>',
  '=HYPERLINK("x").png',
  '-1+1.png',
  'x'.repeat(10_000),
  '骨'.repeat(10_000),
  '𝔟'.repeat(10_000),
  `a.png #${'9'.repeat(5_000)}`,
  '__proto__',
  'trailing. . .',
];

const square: Outline = { points: [framePoint(5, 5), framePoint(25, 5), framePoint(25, 25)], closed: true, unknownSides: [] };

function docOf(names: readonly string[]): Doc {
  const frames = names.map((name, index) => ({ id: `f${index}`, name, source: 's', indexInSource: index, width: 100, height: 80 }));
  const cells = Cells.from(frames.map(({ id }) => [cellKey(id, 'femur'), { outline: square, result: null, resultOf: null }]));
  return { ...EMPTY_DOC, frames, cells };
}

/** A name that every file system keeps, in the folder where it is put. */
function isSafe(name: string): boolean {
  const device = /^(?:aux|con|nul|prn|com\d|lpt\d)(?:\.|$)/i;
  return /^[\p{L}\p{N}_-][\p{L}\p{N}._-]*$/u.test(name) && !name.endsWith('.') && !device.test(name) && new TextEncoder().encode(name).length <= 255;
}

describe('names of files', () => {
  it.each(HOSTILE.map((name, at) => [at, name] as const))('number %i begins one that is safe everywhere', (_, name) => {
    const stem = fileStem(name);
    for (const file of [`${stem}.mot`, sessionName(name, false), `${stem}_joint.csv`]) expect(isSafe(file), file).toBe(true);
  });

  it('of a session with its files and of one without are two', () => {
    expect([true, false].map((withFiles) => sessionName('knee 7', withFiles))).toEqual(['knee_7.fluoropose.json', 'knee_7_without_files.fluoropose.json']);
  });

  it('say what the study is called where they can', () => {
    expect(fileStem('  Knee 3, left ')).toBe('Knee_3_left');
    expect(fileStem('膝 左')).toBe('膝_左');
    expect(fileStem('console')).toBe('console');
    expect(fileStem('***')).toBe('_');
    expect(fileStem('..')).toBe('study');
  });

  it('in a zip are safe, and no two are one', () => {
    const names = [...HOSTILE, ...HOSTILE, 'a.png', 'A.png', 'a.png', 'a_2.png', 'a.png'];
    const paths = masksOf(docOf(names)).map(({ path }) => path);
    expect(paths.length).toBe(names.length);
    expect(new Set(paths.map((path) => path.toLowerCase())).size).toBe(names.length);
    for (const path of paths) {
      const [folder, name = '', ...deeper] = path.split('/');
      expect([folder, deeper]).toEqual(['femur', []]);
      expect(isSafe(name), name).toBe(true);
    }
  });
});

describe('tables', () => {
  it('hold no formula, and every name in its own row', () => {
    const signs = ['=1+1', '+1', '-1', '@SUM(A1)', '\t=1', '\r\n=1', ' =1', '＝1', '=HYPERLINK("x","y")'];
    const rows = poseTable(docOf(signs), 'femur').split('\r\n').slice(1, -1);
    expect(rows.length).toBe(signs.length);
    for (const row of rows) expect(row).toMatch(/^\d,"?' {0,2}[=+\-@＝]/);
  });

  it('keep numbers as they are, and text that begins no formula', () => {
    expect(tableOf([[-1.5, 2e-7, null, "it's -1", 'a=b', '']])).toBe("-1.5,2e-7,,it's -1,a=b,\r\n");
  });
});
