/**
 * What is under way, counted. Nothing of the page depends on it: it is there so that whoever looks at the page from
 * outside (its tests, a measurement) can wait until it has come to rest instead of for so long.
 */
class Activity {
  #count = 0;
  #waiting: (() => void)[] = [];

  /** Counts something until what this returns is called; a second call does nothing. */
  begin(): () => void {
    this.#count++;
    let over = false;
    return () => {
      if (over) return;
      over = true;
      if (--this.#count > 0) return;
      const waiting = this.#waiting;
      this.#waiting = [];
      for (const resolve of waiting) resolve();
    };
  }

  get isOver(): boolean {
    return this.#count === 0;
  }

  /** The next moment at which nothing is under way: at once, if nothing is. */
  over(): Promise<void> {
    return this.isOver ? Promise.resolve() : new Promise((resolve) => this.#waiting.push(resolve));
  }
}

/** Words and numbers that are soon to be renewed. */
export const renewals = new Activity();

/** Calls into workers, the pauses before them, jobs, and what flashes because it has changed. */
export const work = new Activity();

/** Resolves once the page shows what it knew when this was called, whatever work goes on. */
export async function shown(): Promise<void> {
  // The stage is drawn, and has said what lies under the pointer.
  await nextFrame();
  await renewals.over();
  // Views draw pictures of their own after the screen frame in which they were renewed, and may renew others by that.
  for (let round = 0; round < 2; round++) {
    await nextFrame();
    await nextTask();
  }
}

/** Resolves once no work is under way and the page shows what came of it. */
export async function atRest(): Promise<void> {
  do {
    await work.over();
    await shown();
  } while (!work.isOver || !renewals.isOver);
}

function nextFrame(): Promise<void> {
  return new Promise((resolve) => requestAnimationFrame(() => resolve()));
}

function nextTask(): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve));
}
