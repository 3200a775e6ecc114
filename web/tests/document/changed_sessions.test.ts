import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { ReadError } from '../../src/document/reader';
import { checksum } from '../../src/document/session/checksum';
import { readSession, writeSession, type Session } from '../../src/document/session/session';

/** `cargo xtask fuzz` says how long; else a moment. */
const SECONDS = Number(process.env['FLUOROPOSE_FUZZ_SECONDS'] ?? 0.3);
/** Every bit takes some ten seconds. */
const STEP = process.env['FLUOROPOSE_FUZZ_SECONDS'] === undefined ? 13 : 1;
const SEED = Number(process.env['FLUOROPOSE_FUZZ_SEED'] ?? 1);

const fixtures = [1, 2, 3, 4, 5].map((version) => readFileSync(new URL(`fixtures/session-v${version}.fluoropose.json`, import.meta.url), 'utf8'));
const ODD: unknown[] = [null, true, '', 'x', '__proto__', -1, 0.5, 1e308, 2 ** 53, [], {}, [[]], { a: null }];

/** Mulberry32. */
function randomOf(seed: number): (most: number) => number {
  let state = seed >>> 0;
  return (most) => {
    state = (state + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return Math.floor((((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32) * most);
  };
}

/** One value anywhere becomes another, goes, or comes twice. */
function changed(value: unknown, below: (most: number) => number): unknown {
  if (typeof value !== 'object' || value === null || below(6) === 0) return ODD[below(ODD.length)];
  const keys = Object.keys(value);
  if (keys.length === 0) return ODD[below(ODD.length)];
  const key = keys[below(keys.length)]!;
  const part = (value as Record<string, unknown>)[key];
  if (Array.isArray(value)) return value.toSpliced(Number(key), 1, ...[[], [part, part], [changed(part, below)]][below(8)] ?? [changed(part, below)]);
  const { [key]: _, ...rest } = value as Record<string, unknown>;
  const name = below(10) === 0 ? keys[below(keys.length)]! : key;
  return below(8) === 0 ? rest : { ...rest, [name]: changed(part, below) };
}

/** Refused with a sentence, or read; the same again after it was written. */
function isRead(json: string): boolean {
  let session: Session;
  try {
    session = readSession(json);
  } catch (error) {
    if (error instanceof ReadError) return false;
    throw error;
  }
  expect(readSession(writeSession(session, 'x', new Date(0)).join('')).doc).toEqual(session.doc);
  return true;
}

describe('changed sessions', () => {
  it('are refused with a sentence, or read and written', { timeout: 2000 * SECONDS + 20_000 }, () => {
    const below = randomOf(SEED);
    const end = Date.now() + 1000 * SECONDS;
    let [runs, read] = [0, 0];
    do {
      const { checksum: _, ...whole } = JSON.parse(fixtures[below(fixtures.length)]!) as Record<string, unknown>;
      let value: unknown = whole;
      for (let count = 1 + below(3); count > 0; count--) value = changed(value, below);
      if (isRead(JSON.stringify(value))) read++;
      runs++;
    } while (Date.now() < end);
    expect(read).toBeGreaterThan(0);
    expect(read).toBeLessThan(runs);
    console.log(`sessions: ${runs} changed, ${read} of them read, no other error`);
  });

  it('every single bit is refused, or changes nothing', { timeout: 120_000 }, () => {
    const session = readSession(fixtures[4]!);
    const file = { name: 'f', sha256: 'ab', bytes: Uint8Array.of(1, 2, 3) };
    const text = writeSession({ ...session, files: [file] }, 'x', new Date(0)).join('');
    const bytes = new TextEncoder().encode(text);
    const inFile = new TextEncoder().encode(text.slice(0, text.indexOf('"base64":"') + '"base64":"'.length)).length;
    let [refused, harmless, told] = [0, 0, 0];
    for (let bit = 0; bit < 8 * bytes.length; bit += STEP) {
      bytes[bit >> 3]! ^= 1 << (bit & 7);
      try {
        const found = readSession(new TextDecoder().decode(bytes));
        // Its SHA-256 tells when it is opened.
        if (bit >> 3 >= inFile && found.files.length === 1 && found.files[0]!.bytes?.join() !== '1,2,3') told++;
        else harmless++;
        expect(found.doc, `bit ${bit}`).toEqual(session.doc);
        expect(found.view, `bit ${bit}`).toEqual(session.view);
        expect(found.audit, `bit ${bit}`).toEqual(session.audit);
      } catch (error) {
        if (!(error instanceof ReadError)) throw error;
        refused++;
      }
      bytes[bit >> 3]! ^= 1 << (bit & 7);
    }
    expect(refused).toBeGreaterThan(50 * (harmless + told));
    console.log(`session of ${bytes.length} bytes: ${refused} bits refused, ${harmless} change nothing, ${told} are told by a file's digest`);
  });

  it('have the checksum that zips have', () => {
    expect(checksum('123456789')).toBe(0xcbf43926);
  });
});
