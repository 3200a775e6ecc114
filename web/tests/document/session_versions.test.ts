import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { auditOf, auditTroubles } from '../../src/document/session/audit';
import { filmNumbers } from '../../src/document/film';
import { readSession, SESSION_VERSION, writeSession } from '../../src/document/session/session';
import { cellKey, cellOf, chosenCandidate, DEFAULT_WINDOW, UNKNOWN_FILM, verdictOf } from '../../src/document/types';

/** One file of each version there ever was: what somebody saved stays readable. */
const file = (version: number) => readFileSync(new URL(`fixtures/session-v${version}.fluoropose.json`, import.meta.url), 'utf8');

describe('sessions of earlier versions', () => {
  it.each(Array.from({ length: SESSION_VERSION }, (_, index) => index + 1))('version %i is read', (version) => {
    const { doc, view, files } = readSession(file(version));
    expect(doc.name).toBe(`version ${version}`);
    expect(doc.side).toBe('right');
    expect(doc.frames.map(({ name }) => name)).toEqual(['film.tif #1', 'film.tif #2']);
    expect(view).toEqual({ frameIndex: 1, component: 'tibia', overlayOpacity: 0.5 });
    expect(files.map(({ name, bytes }) => [name, bytes?.length ?? null])).toEqual([['film.tif', 40], ['fem.stl', null]]);
    const [first, second] = doc.frames.map(({ id }) => id);
    const posed = cellOf(doc, first, 'femur');
    expect(posed.outline?.unknownSides).toEqual([1]);
    expect(posed.resultOf).toBe(posed.outline);
    expect(chosenCandidate(posed)?.pose.x).toBe(4.605862);
    expect(cellOf(doc, second, 'femur').result).toMatchObject({ from: 'file', origin: 'fem.jts' });
    expect(cellOf(doc, first, 'tibia').result).toMatchObject({ kind: 'failed' });
    expect(cellOf(doc, second, 'tibia').outline).toMatchObject({ closed: false });
  });

  it('version 1 has no marks and no audit', () => {
    const { doc, audit } = readSession(file(1));
    expect(doc.marks).toEqual({});
    expect(audit).toBeNull();
  });

  it.each([1, 2])('version %i has windows of views and no verdicts', (version) => {
    const { doc } = readSession(file(version));
    expect(doc.components.femur.librarySpec).toEqual(DEFAULT_WINDOW);
    const { result } = cellOf(doc, doc.frames[0]!.id, 'femur');
    expect(result).toMatchObject({ verdict: null });
    expect(chosenCandidate(cellOf(doc, doc.frames[0]!.id, 'femur'))?.judged).toBeNull();
  });

  it('version 3 has libraries of all directions beside windows, and verdicts', () => {
    const { doc } = readSession(file(3));
    expect(doc.components.femur.librarySpec).toEqual({ views: 'all directions', distance: 1080 });
    expect(doc.components.tibia.librarySpec).toMatchObject({ views: 'window', yTo: 20 });
    const cell = cellOf(doc, doc.frames[0]!.id, 'femur');
    expect(verdictOf(cell.result)).toEqual({ word: 'doubtful', because: 'only 40 % of the model\u2019s outline is known' });
    expect(chosenCandidate(cell)?.judged?.misfit).toBe(0.34);
  });

  it.each([1, 2, 3])('version %i has no axes: the shapes are asked', (version) => {
    const { femur, tibia } = readSession(file(version)).doc.components;
    expect([femur.axes, tibia.axes]).toEqual([null, null]);
  });

  it('version 4 has axes, and an audit with verdicts that fits', async () => {
    const { doc, audit } = readSession(file(4));
    expect(doc.components.femur.axes).toMatchObject({ from: 'shape', told: 'all' });
    expect(doc.components.tibia.axes).toEqual({ directions: [[0, 1, 0], [0, 0, 1], [1, 0, 0]], from: 'person', told: 'all' });
    expect(audit?.results.map(({ component, method, verdict }) => [component, method, verdict?.word ?? null])).toEqual([
      ['femur', 'refined', 'doubtful'],
      ['tibia', 'none', 'none'],
      ['femur', 'file fem.jts', null],
    ]);
    expect(await auditTroubles(doc, audit!)).toEqual([]);
  });

  it.each([1, 2, 3, 4])('version %i knows no film', (version) => {
    expect(readSession(file(version)).doc.film).toEqual(UNKNOWN_FILM);
  });

  it('version 4 does not say that a click found a pose: it is seen by what was never drawn', () => {
    const clicked = file(4).replace(/"unmatched":\d+,"drawn":\d+/g, '"unmatched":null,"drawn":null');
    const { frames, ...doc } = readSession(clicked).doc;
    expect(cellOf({ frames, ...doc }, frames[0]!.id, 'femur').result).toMatchObject({ onFrame: { film: null } });
    expect(cellOf(readSession(file(4)).doc, frames[0]!.id, 'femur').result).not.toHaveProperty('onFrame');
  });

  it('version 5 has the film, by which poses were found on the frame', async () => {
    const { doc, audit } = readSession(file(5));
    expect(doc.film.stated).toEqual({ display: 'logarithmic', blur: null, constants: null });
    expect(filmNumbers(doc, 'femur')?.slice(0, 3)).toEqual([0.0263, 0.82, 0.71]);
    expect(filmNumbers(doc, 'tibia')).toBeNull();
    const { result } = cellOf(doc, doc.frames[0]!.id, 'femur');
    expect(result).toMatchObject({ onFrame: { film: [0.0263, 0.82, 0.71] }, candidates: [{ support: 0.91 }, {}] });
    expect(audit?.results[0]?.method).toBe('refined on the frame by its film');
    expect(await auditTroubles(doc, audit!)).toEqual([]);
  });

  it.each([
    ['[0,1,0],[0,0,1],[1,0,0]', '[0,1,0],[0,0,1],[-1,0,0]'],
    ['[0,1,0],[0,0,1],[1,0,0]', '[0,1,0],[0,0,1]'],
  ])('axes that are no frame are refused: %s as %s', (from, to) => {
    expect(() => readSession(file(4).replace(from, to))).toThrow(/components\.tibia\.axes\.directions should be three directions/);
  });

  it('version 2 has marks, and an audit that fits', async () => {
    const { doc, audit } = readSession(file(2));
    const key = cellKey(doc.frames[0]!.id, 'femur');
    expect(doc.marks[key]).toMatchObject({ flagged: true, note: 'cement over the rim' });
    expect(audit?.results.map(({ method, program }) => [method, program])).toEqual([
      ['refined', 'fluoropose 0.1.0'],
      ['file fem.jts', null],
    ]);
    expect(await auditTroubles(doc, audit!)).toEqual([]);
  });
});

describe('audit', () => {
  const session = () => readSession(file(2));

  it('names every input with its digest', async () => {
    const { doc } = session();
    const { inputs } = await auditOf(doc);
    expect(inputs.map(({ role, name }) => `${role} ${name}`)).toEqual(['frames film.tif', 'calibration c.txt', 'femur model fem.stl']);
    for (const { sha256 } of inputs) expect(sha256).toMatch(/^[0-9a-f]{64}$/);
  });

  it.each([
    ['[1.25,2]', '[1.26,2]', /^Frame 1 \(film\.tif #1\), femur: the outline was changed after the session was saved$/],
    ['JT_INTCALIB\\n1198', 'JT_INTCALIB\\n1199', /^The calibration c\.txt: SHA-256 \w{12}\.\.\. in the session, \w{12}\.\.\. when its results were saved$/],
  ])('says what was changed: %s to %s', async (from, to, sentence) => {
    const [head, tail] = file(2).split('"document":') as [string, string];
    const changed = readSession(`${head}"document":${tail.replace(from, to)}`);
    const troubles = await auditTroubles(changed.doc, changed.audit!);
    expect(troubles.join('\n')).toMatch(sentence);
  });

  it('tells a pose that was changed by hand in the file', async () => {
    const [head, tail] = file(2).split('"document":') as [string, string];
    const changed = readSession(`${head}"document":${tail.replace('"x":4.605862', '"x":4.7')}`);
    expect(await auditTroubles(changed.doc, changed.audit!)).toEqual([
      'Frame 1 (film.tif #1), femur: the pose was changed after the session was saved',
    ]);
  });

  it('is lost in no round trip', async () => {
    const { doc, view, files, audit } = session();
    const again = readSession(writeSession({ doc, view, files, audit }, 'fluoropose 0.1.0', new Date(0)).join(''));
    expect(again.audit).toEqual(audit && { ...audit, results: audit.results.map((record) => ({ ...record, verdict: null })) });
  });
});
