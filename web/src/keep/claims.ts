/**
 * Which work belongs to which tab: a tab holds a lock for each work that it has open, and the browser lets go of it
 * when the tab is gone, however it went.
 */
export class Claims {
  readonly #held = new Set<string>();
  readonly #locks: LockManager | undefined;

  constructor(locks: LockManager | undefined = globalThis.navigator?.locks) {
    this.#locks = locks;
  }

  /** True if this tab has the work now, false if another tab does. */
  async claim(id: string): Promise<boolean> {
    if (this.#held.has(id)) return true;
    if (!this.#locks) throw new Error('this browser has no locks between tabs');
    const locks = this.#locks;
    const granted = await new Promise<boolean>((resolve, reject) => {
      locks
        .request(`fluoropose work ${id}`, { ifAvailable: true }, (lock) => {
          resolve(lock !== null);
          // Held until the tab is gone.
          return lock === null ? null : new Promise<void>(() => undefined);
        })
        .catch(reject);
    });
    if (granted) this.#held.add(id);
    return granted;
  }
}
