import { describe, expect, it } from 'vitest';
import { LibraryPool } from '../../src/jobs/library_pool';
import type { LibraryPlan, LibraryProtocol } from '../../src/workers/protocol/library';
import { Aborted, type Bridge } from '../../src/workers/bridge';

const VIEWS = 100;
const PLAN = {} as LibraryPlan;

interface Call {
  readonly worker: number;
  readonly method: string;
  readonly input: { first: number; count: number; parts: readonly Uint8Array[] };
  readonly answer: (output: unknown) => void;
  readonly fail: (error: Error) => void;
}

/** A pool whose workers answer when the test says so. */
function bench(size: number) {
  const calls: Call[] = [];
  const dismissed: number[] = [];
  let hired = 0;
  const pool = new LibraryPool(size, () => {
    const worker = hired++;
    const call = (method: string, input: Call['input'], { signal }: { signal: AbortSignal }) =>
      new Promise((answer, fail) => {
        signal.addEventListener('abort', () => fail(new Aborted()));
        calls.push({ worker, method, input, answer, fail });
      });
    return { call, dispose: () => dismissed.push(worker) } as unknown as Bridge<LibraryProtocol>;
  });
  return { pool, calls, dismissed, hired: () => hired };
}

/** Lets promises go on. */
const settled = () => new Promise((resolve) => setTimeout(resolve));

async function planned(calls: Call[]): Promise<void> {
  await settled();
  for (const { answer } of calls.splice(0)) answer(VIEWS);
  await settled();
}

/** What a worker packs of its views: their numbers. */
function packed({ first, count }: Call['input']): Uint8Array {
  return Uint8Array.from({ length: count }, (_, view) => first + view);
}

const quiet = () => ({ signal: new AbortController().signal, onProgress: () => undefined });

describe('library pool', () => {
  it('puts the views together in their order, whoever packs them and whenever', async () => {
    const { pool, calls, dismissed } = bench(3);
    const told: [number, number][] = [];
    const library = pool.build(PLAN, { ...quiet(), onProgress: (done, total) => told.push([done, total]) });
    await planned(calls);
    while (calls[0]?.method !== 'assemble') {
      const last = calls.pop();
      last?.answer(packed(last.input));
      await settled();
    }
    const [{ input, answer }] = calls as [Call];
    expect(input.parts.flatMap((part) => [...part])).toEqual(Array.from({ length: VIEWS }, (_, view) => view));
    expect(told.at(-1)).toEqual([VIEWS, VIEWS]);
    answer(Uint8Array.of(7));
    expect(await library).toEqual(Uint8Array.of(7));
    await settled();
    expect(dismissed).toEqual([0, 1, 2]);
  });

  it('builds the next with the same workers, once the first is there', async () => {
    const { pool, calls, dismissed, hired } = bench(1);
    const first = pool.build(PLAN, quiet());
    const second = pool.build(PLAN, quiet());
    for (const library of [first, second]) {
      await planned(calls);
      expect(dismissed).toEqual([]);
      while (calls[0]?.method === 'pack') {
        calls.shift()?.answer(new Uint8Array());
        await settled();
      }
      calls.shift()?.answer(Uint8Array.of(1));
      await library;
    }
    await settled();
    expect([hired(), dismissed]).toEqual([1, [0]]);
  });

  it('stops at once when it is called off, and so does one that waits', async () => {
    const { pool, calls } = bench(2);
    const [running, waiting] = [new AbortController(), new AbortController()];
    const first = pool.build(PLAN, { ...quiet(), signal: running.signal });
    const second = pool.build(PLAN, { ...quiet(), signal: waiting.signal });
    await planned(calls);
    waiting.abort();
    await expect(second).rejects.toThrow(Aborted);
    running.abort();
    await expect(first).rejects.toThrow(Aborted);
    await settled();
    expect(calls.every(({ method }) => method === 'pack')).toBe(true);
    expect(calls.length).toBe(2);
  });

  it('asks for no more views once a worker has failed', async () => {
    const { pool, calls } = bench(2);
    const library = pool.build(PLAN, quiet());
    await planned(calls);
    const [one, other] = calls.splice(0) as [Call, Call];
    one.fail(new Error('a trap'));
    await expect(library).rejects.toThrow('a trap');
    other.answer(packed(other.input));
    await settled();
    expect(calls).toEqual([]);
  });
});
