import { work } from '../workers/activity';

/** A pause before work that nobody wants while things change: it begins anew whenever it is asked for. It counts as work, so that who waits for the page to come to rest waits for it. */
export class Pause {
  #timer: ReturnType<typeof setTimeout> | undefined;
  #isOver: () => void = () => undefined;

  /** Does `then` after so many ms, unless the pause begins anew or ends before. What `then` begins at once is counted without a gap. */
  before(ms: number, then: () => void): void {
    this.end();
    const over = (this.#isOver = work.begin());
    this.#timer = setTimeout(() => {
      then();
      over();
    }, ms);
  }

  /** Nothing is waited for any more. */
  end(): void {
    clearTimeout(this.#timer);
    this.#isOver();
  }
}
