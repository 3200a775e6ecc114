/** Something that takes memory until it is let go. */
export interface Held {
  readonly bytes: number;
  free(): void;
}

/**
 * Frames in memory, within a budget of bytes: the ones that were not asked for the longest go first. One that is gone is brought
 * again when somebody asks for it; who asks while it is on its way gets the same one.
 */
export class LeasedFrames<T extends Held> {
  readonly #budget: number;
  readonly #fetch: (id: string, signal: AbortSignal) => Promise<T | null>;
  /** The one that was used last comes last. */
  readonly #held = new Map<string, T>();
  readonly #coming = new Map<string, { readonly frame: Promise<T | null>; readonly abort: AbortController; wanted: boolean }>();
  #bytes = 0;
  #onView: string | null = null;

  /** `fetch` gives null for what is not at hand, and throws for what cannot be read. */
  constructor(budget: number, fetch: (id: string, signal: AbortSignal) => Promise<T | null>) {
    this.#budget = budget;
    this.#fetch = fetch;
  }

  get bytes(): number {
    return this.#bytes;
  }

  /** Null while it is not in memory. */
  get(id: string): T | null {
    const frame = this.#held.get(id);
    if (!frame) return null;
    this.#held.delete(id);
    this.#held.set(id, frame);
    return frame;
  }

  has(id: string): boolean {
    return this.#held.has(id);
  }

  put(id: string, frame: T): void {
    this.#drop(id);
    this.#held.set(id, frame);
    this.#bytes += frame.bytes;
    for (const oldest of [...this.#held.keys()]) {
      if (this.#bytes <= this.#budget) break;
      if (oldest !== id && oldest !== this.#onView) this.#drop(oldest);
    }
  }

  /** Waits until it is in memory; null where it is not at hand. */
  async bring(id: string): Promise<T | null> {
    const here = this.get(id);
    if (here) return here;
    const coming = this.#begin(id);
    coming.wanted = true;
    return coming.frame;
  }

  /**
   * Begins to bring what will soon be asked for; what else was only expected, and nobody waits for, is called off. The first of them
   * is on view and stays, whatever others bring; resolves when it is there.
   */
  async expect(ids: readonly string[]): Promise<void> {
    const [onView = null] = ids;
    this.#onView = onView;
    for (const [id, coming] of this.#coming) if (!coming.wanted && !ids.includes(id)) coming.abort.abort();
    const begun = ids.map((id) => (this.#held.has(id) ? null : this.#begin(id).frame));
    for (const frame of begun) frame?.catch(() => null);
    await begun[0];
  }

  clear(): void {
    for (const id of [...this.#held.keys()]) this.#drop(id);
  }

  #begin(id: string): { readonly frame: Promise<T | null>; wanted: boolean } {
    const known = this.#coming.get(id);
    if (known && !known.abort.signal.aborted) return known;
    const abort = new AbortController();
    const frame = this.#fetch(id, abort.signal).then((fetched) => this.#arrived(id, fetched));
    const coming = { frame, abort, wanted: false };
    this.#coming.set(id, coming);
    const over = () => void (this.#coming.get(id) === coming && this.#coming.delete(id));
    frame.then(over, over);
    return coming;
  }

  #arrived(id: string, fetched: T | null): T | null {
    const here = this.#held.get(id);
    // Somebody may hold the one that came first.
    if (here) fetched?.free();
    else if (fetched) this.put(id, fetched);
    return here ?? fetched;
  }

  #drop(id: string): void {
    const frame = this.#held.get(id);
    if (!frame) return;
    this.#held.delete(id);
    this.#bytes -= frame.bytes;
    frame.free();
  }
}
