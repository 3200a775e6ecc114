import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { Cells } from '../../src/document/cells';
import { poseTable } from '../../src/document/session/table';
import { cellKey, EMPTY_DOC, type Candidate, type Doc, type Failed, type Posed } from '../../src/document/types';
import { decimalsFor, formatDeviation, formatNumber, NARROW, plusMinus } from '../../src/texts/numbers';

describe('numbers', () => {
  it.each([
    [null, 2, 2],
    [0.0213, 2, 2],
    [0.13, 2, 2],
    [1.24, 2, 1],
    [12.4, 2, 0],
    [0.0042, 2, 3],
    [0.00001, 2, 3],
    [0.31, 1, 1],
    [0.04, 1, 2],
  ])('with a deviation of %s and usually %i decimals have %i', (deviation, usual, wanted) => {
    expect(decimalsFor(deviation, usual)).toBe(wanted);
  });

  it('with a standard deviation are written as report and commands write them', () => {
    const text = readFileSync(new URL('../../../tests/corpus/plus_minus.txt', import.meta.url), 'utf8');
    const lines = text.trimEnd().split('\n').slice(1);
    expect(lines.length).toBeGreaterThan(10);
    for (const line of lines) {
      const [numbers = '', written] = line.split(': ');
      const [value = NaN, deviation = NaN, usual = NaN] = numbers.split(' ').map(Number);
      expect(plusMinus(value, deviation, usual).replaceAll(NARROW, ' '), line).toBe(written);
    }
  });

  it('have a true minus sign, and none before zero', () => {
    expect([formatNumber(-1.25, 1), formatNumber(-0.001, 2)]).toEqual(['\u22121.3', '0.00']);
  });

  it('are never said to be without any doubt', () => {
    expect([formatDeviation(0.00001, 3), formatDeviation(0.31, 1)]).toEqual(['0.001', '0.3']);
  });
});

const pose = { x: 4.5, y: -17, z: -1083.741, zRot: 7.9, xRot: 5.6, yRot: -1.2 };
const deviations = { x: 0.02, y: 0.03, z: 0.3, zRot: 0.04, xRot: 0.05, yRot: 0.06 };
const refined: Candidate = { pose, unmatched: 600, drawn: 40, residual: 0.21, deviations, judged: { misfit: 0.3, verdict: { word: 'good', because: 'it fits' } } };
const frame = (id: string, name: string) => ({ id, name, source: id, indexInSource: 0, width: 9, height: 9 });

function docOf(result: Posed | Failed): Doc {
  return { ...EMPTY_DOC, frames: [frame('a', 'a, "1".png'), frame('b', 'b.png')], cells: Cells.from([[cellKey('a', 'tibia'), { outline: null, result, resultOf: null }]]) };
}

describe('the table of poses', () => {
  const posed: Posed = {
    kind: 'posed',
    from: 'outline',
    origin: 'k',
    candidates: [refined, { ...refined, pose: { ...pose, x: 9 }, deviations: null }],
    chosen: 0,
    reason: 'By the coronal tilt, 0.4° against 4.0°.',
    decided: true,
    verdict: { word: 'doubtful', because: 'another pose, 110 degrees away, fits as well' },
  };

  it('has a row a frame with numbers, standard deviations and the reason', () => {
    const [head, first, second, ...rest] = poseTable(docOf(posed), 'tibia').split('\r\n');
    expect(head?.split(',').length).toBe(21);
    expect(first).toBe(
      '1,"a, ""1"".png",4.5,-17,-1083.741,7.9,5.6,-1.2,0.02,0.03,0.3,0.04,0.05,0.06,0.21,doubtful,"another pose, 110 degrees away, fits as well",refined,1,2,"By the coronal tilt, 0.4° against 4.0°."',
    );
    expect(second).toBe(`2,b.png${','.repeat(19)}`);
    expect(rest).toEqual(['']);
  });

  it('has no numbers, and the reason, where nothing fits', () => {
    const row = poseTable(docOf({ kind: 'failed', origin: 'k', sentence: 'The outline does not fit this model' }), 'tibia').split('\r\n')[1];
    expect(row).toBe(`1,"a, ""1"".png"${','.repeat(14)}none,The outline does not fit this model,,,,`);
  });

  it('says what was chosen by hand and leaves out what is not known', () => {
    const row = poseTable(docOf({ ...posed, chosen: 1 }), 'tibia').split('\r\n')[1];
    expect(row).toMatch(/,9,-17,.*,,,,,,,0\.21,doubtful,"it was taken by hand in place of the first, which was doubtful: [^"]*",refined,2,2,Chosen by hand\.$/);
  });
});
