import { Aborted, type Bridge } from '../workers/bridge';
import type { LibraryPlan, LibraryProtocol } from '../workers/protocol/library';

/** Views that a worker draws before it asks for more: some hundredths of a second, after which it can be called off. */
const VIEWS_AT_A_TIME = 24;

/** Each has memory of its own, some megabytes; that more than these save time was not tried. */
const MOST_WORKERS = 8;

/** One core is left for the page, unless that were half of all. */
export function workersFor(cores: number): number {
  return Math.min(cores, Math.max(2, cores - 1), MOST_WORKERS);
}

interface Build {
  readonly signal: AbortSignal;
  readonly onProgress: (done: number, total: number) => void;
}

/**
 * Builds libraries, one after the other, each with all its workers: the first is there as soon as it can be. Workers
 * start with the first library and are let go when none is wanted.
 */
export class LibraryPool {
  readonly #size: number;
  readonly #hire: () => Bridge<LibraryProtocol>;
  #workers: readonly Bridge<LibraryProtocol>[] = [];
  #turn: Promise<unknown> = Promise.resolve();
  #wanted = 0;

  constructor(size: number, hire: () => Bridge<LibraryProtocol>) {
    this.#size = size;
    this.#hire = hire;
  }

  /** The library's bytes. Throws `Aborted` as soon as it is called off. */
  async build(plan: LibraryPlan, options: Build): Promise<Uint8Array<ArrayBuffer>> {
    this.#wanted += 1;
    const built = this.#turn.then(() => this.#build(plan, options));
    this.#turn = built.catch(() => undefined).then(() => this.#rest());
    return Promise.race([built, aborted(options.signal)]);
  }

  async #build(plan: LibraryPlan, { signal, onProgress }: Build): Promise<Uint8Array<ArrayBuffer>> {
    if (signal.aborted) throw new Aborted();
    if (this.#workers.length === 0) this.#workers = Array.from({ length: this.#size }, this.#hire);
    const parts: Uint8Array<ArrayBuffer>[] = [];
    const work = { plan, signal, onProgress, parts, next: 0, done: 0 };
    await Promise.all(this.#workers.map((worker) => packSome(worker, work)));
    const [first] = this.#workers;
    if (!first) throw new Aborted();
    return first.call('assemble', { parts }, { signal, transfer: parts.map(({ buffer }) => buffer) });
  }

  #rest(): void {
    this.#wanted -= 1;
    if (this.#wanted > 0) return;
    for (const worker of this.#workers) worker.dispose();
    this.#workers = [];
  }
}

/** What the workers of a library share. */
interface Work extends Build {
  readonly plan: LibraryPlan;
  /** In the order of their views. */
  readonly parts: Uint8Array<ArrayBuffer>[];
  /** The first view that nobody has taken on, and how many are there. */
  next: number;
  done: number;
}

async function packSome(worker: Bridge<LibraryProtocol>, work: Work): Promise<void> {
  const { plan, signal, parts, onProgress } = work;
  try {
    const total = await worker.call('plan', plan, { signal });
    while (work.next < total) {
      const first = work.next;
      const count = Math.min(VIEWS_AT_A_TIME, total - first);
      work.next = first + count;
      parts[first / VIEWS_AT_A_TIME] = await worker.call('pack', { first, count }, { signal });
      work.done += count;
      onProgress(work.done, total);
    }
  } catch (error) {
    // The others need not go on.
    work.next = Infinity;
    throw error;
  }
}

function aborted(signal: AbortSignal): Promise<never> {
  return new Promise((_, reject) => {
    const stop = () => reject(new Aborted());
    if (signal.aborted) stop();
    else signal.addEventListener('abort', stop, { once: true });
  });
}
