import { describe, expect, it } from 'vitest';
import { LeasedFrames } from '../../src/films/leased_frames';

/** Ten bytes each; what was fetched and freed, in order. */
function bench(budget: number, missing: readonly string[] = []) {
  const fetched: string[] = [];
  const freed: string[] = [];
  const signals = new Map<string, AbortSignal>();
  const leases = new LeasedFrames(budget, async (id: string, signal: AbortSignal) => {
    fetched.push(id);
    signals.set(id, signal);
    await Promise.resolve();
    if (id === 'broken') throw new Error('cut short');
    return missing.includes(id) ? null : { id, bytes: 10, free: () => void freed.push(id) };
  });
  return { leases, fetched, freed, signals };
}

describe('leased frames', () => {
  it('stay within the budget; what was not used the longest goes first', async () => {
    const { leases, freed } = bench(30);
    for (const id of ['a', 'b', 'c']) await leases.bring(id);
    leases.get('a');
    await leases.bring('d');
    expect(freed).toEqual(['b']);
    expect([leases.bytes, leases.has('a'), leases.has('b')]).toEqual([30, true, false]);
    for (let number = 0; number < 500; number++) await leases.bring(`film ${number}`);
    expect(leases.bytes).toBe(30);
    expect(freed).toHaveLength(501);
  });

  it('the one that was just brought is there, however small the budget', async () => {
    const { leases } = bench(1);
    await leases.bring('a');
    expect(leases.get('a')?.id).toBe('a');
    await leases.bring('b');
    expect([leases.has('a'), leases.has('b')]).toEqual([false, true]);
  });

  it('one that is on its way is not fetched twice, and one that is gone is fetched again', async () => {
    const { leases, fetched } = bench(10);
    const [first, second] = await Promise.all([leases.bring('a'), leases.bring('a')]);
    expect(first).toBe(second);
    expect(leases.get('b')).toBeNull();
    await leases.bring('b');
    await leases.bring('a');
    expect(fetched).toEqual(['a', 'b', 'a']);
  });

  it('what is expected comes ahead, and is called off when something else is, unless somebody waits for it', async () => {
    const { leases, fetched, signals } = bench(100);
    // The bench's own decoding does not listen to its signal: what was called off is there all the same.
    void leases.expect(['a', 'b']);
    const waited = leases.bring('b');
    void leases.expect(['c']);
    expect([signals.get('a')?.aborted, signals.get('b')?.aborted]).toEqual([true, false]);
    expect((await waited)?.id).toBe('b');
    await leases.bring('c');
    expect(fetched).toEqual(['a', 'b', 'c']);
    // Nobody has to hear of it where it fails, until somebody asks.
    void leases.expect(['broken']).catch(() => null);
    await expect(leases.bring('broken')).rejects.toThrow('cut short');
    await expect(leases.bring('broken')).rejects.toThrow('cut short');
  });

  it('the one on view stays, however many others are brought', async () => {
    const { leases } = bench(30);
    await leases.expect(['shown']);
    for (let number = 0; number < 20; number++) await leases.bring(`film ${number}`);
    expect(leases.has('shown')).toBe(true);
    void leases.expect(['film 19']);
    for (let number = 0; number < 3; number++) await leases.bring(`more ${number}`);
    expect([leases.has('shown'), leases.has('film 19')]).toEqual([false, true]);
  });

  it('what is not at hand is nowhere, and is asked for again', async () => {
    const { leases, fetched } = bench(100, ['x']);
    expect(await leases.bring('x')).toBeNull();
    expect(await leases.bring('x')).toBeNull();
    expect([fetched.length, leases.has('x')]).toEqual([2, false]);
  });

  it('all of them can be let go', async () => {
    const { leases, freed } = bench(100);
    await leases.bring('a');
    leases.clear();
    expect([freed, leases.bytes]).toEqual([['a'], 0]);
  });
});
