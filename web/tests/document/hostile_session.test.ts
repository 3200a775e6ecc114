import { describe, expect, it } from 'vitest';
import { readSession, writeSession } from '../../src/document/session/session';
import { chosenCandidate, EMPTY_DOC, type Doc } from '../../src/document/types';

const pose = { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };

function sessionWith(change: (document: Record<string, unknown>) => void): string {
  const frame = { id: 'a', name: 'a', source: 'a', indexInSource: 0, width: 9, height: 9 };
  const doc: Doc = { ...EMPTY_DOC, frames: [frame] };
  const view = { frameIndex: 0, component: 'femur' as const, overlayOpacity: 1 };
  const plain = JSON.parse(writeSession({ doc, view, audit: null, files: [] }, 'x', new Date(0)).join('')) as Record<string, Record<string, unknown>>;
  // Whoever changes one on purpose takes it out.
  delete plain['checksum'];
  change(plain['document']!);
  return JSON.stringify(plain);
}

/** As JSON has it: a literal would set the prototype. */
const own = (key: string, value: unknown) => JSON.parse(`{${JSON.stringify(key)}:${JSON.stringify(value)}}`) as unknown;

const posed = (chosen: number, count: number) => ({
  kind: 'posed',
  from: 'outline',
  origin: 'x',
  candidates: Array.from({ length: count }, () => ({ pose, unmatched: null, drawn: null })),
  chosen,
});
const cell = (result: unknown) => ({ outline: null, result, resultIsCurrent: false });

describe('a session of another origin', () => {
  it('changes no prototype, whatever its keys', () => {
    for (const key of ['__proto__', 'constructor', 'prototype', '__proto__/femur', 'a/__proto__', 'a/constructor']) {
      const json = sessionWith((document) => {
        document['marks'] = own(key, { checked: null, flagged: true, note: 'x' });
        document['cells'] = own(key, cell(null));
        document['__extra'] = own(key, { flagged: true });
      });
      try {
        expect(Object.keys(readSession(json).doc)).not.toContain('__extra');
      } catch (error) {
        expect(String(error)).toMatch(/document\./);
      }
      expect(({} as Record<string, unknown>)['flagged']).toBeUndefined();
      expect(({} as Record<string, unknown>)['note']).toBeUndefined();
    }
  });

  it('names no cell of a component that there is not', () => {
    for (const key of ['a', 'a/patella', 'a/__proto__', '/']) {
      expect(() => readSession(sessionWith((document) => (document['cells'] = own(key, cell(null)))))).toThrow(/document\.cells/);
    }
  });

  it('chooses no candidate that there is not', () => {
    for (const [chosen, count] of [[1, 1], [7, 2], [1, 0]] as const) {
      expect(() => readSession(sessionWith((document) => (document['cells'] = { 'a/femur': cell(posed(chosen, count)) })))).toThrow(/chosen/);
    }
    const { doc } = readSession(sessionWith((document) => (document['cells'] = { 'a/femur': cell(posed(1, 2)) })));
    expect(chosenCandidate(doc.cells.at('a', 'femur')!)?.pose).toEqual(pose);
  });

  it('keeps names as the texts that they are', () => {
    for (const name of ['<img src=x onerror=alert(1)>', '\u202egnp.exe', 'x'.repeat(10_000)]) {
      expect(readSession(sessionWith((document) => (document['name'] = name))).doc.name).toBe(name);
    }
  });
});
