import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { byName } from '../../src/exchange/name_order';

describe('the order of names', () => {
  it('is that of the commands', () => {
    const text = readFileSync(new URL('../../../tests/corpus/name_order.txt', import.meta.url), 'utf8');
    const known = text.trimEnd().split('\n');
    expect(known.length).toBeGreaterThan(40);
    expect([...known].reverse().sort(byName)).toEqual(known);
  });
});
