/** What the page asks of its workers: in which order, and held back where a test would else have to be quicker than they are. */

/** @typedef {import('playwright-core').Page} Page */

/** What a press of the mouse is among the calls. */
export const PRESS = 'press';

export class Calls {
  /** @param {Page} page */
  constructor(page) {
    this.page = page;
  }

  /**
   * Notes calls from now on. Of one method so many go to the workers, the rest waits until it is let go.
   *
   * @param {Page} page
   * @param {{ method: string, most: number }} held
   */
  static async of(page, held) {
    await page.evaluate(note, { ...held, press: PRESS });
    return new Calls(page);
  }

  /** Methods, and presses of the mouse between them. @returns {Promise<string[]>} */
  seen() {
    return this.page.evaluate(() => globalThis.callsOfWorkers.seen);
  }

  /** So many more go to the workers. @param {number} more */
  async allow(more) {
    await this.page.evaluate((more) => globalThis.callsOfWorkers.allow(more), more);
  }

  /** What waits goes to the workers, and nothing waits any more. */
  async letGo() {
    await this.page.evaluate(() => globalThis.callsOfWorkers.letGo());
  }
}

/**
 * Until the page is loaded anew, the worker that compares the film with the constants by which it was followed is told other ones: a film that its constants do not fit would
 * have to be twice as long.
 *
 * @param {Page} page
 */
export async function followedWithOtherConstants(page) {
  await page.evaluate(() => {
    const own = Worker.prototype.postMessage;
    Worker.prototype.postMessage = /** @this {Worker} @param {any} message @param {any} transfer */ function (message, transfer) {
      // Its first number is the curvature of what displays the film: grey values for a factor of e were half as many.
      const other = (/** @type {{ known: number[] }} */ one) => ({ ...one, known: one.known.map((number, at) => (at === 0 ? 2 * number : number)) });
      const { method, input } = message;
      own.call(this, method === 'learntAgain' ? { ...message, input: { ...input, followed: input.followed.map(other) } } : message, transfer);
    };
  });
}

/** Runs in the page. @param {{ method: string, most: number, press: string }} held */
function note({ method, most, press }) {
  const own = Worker.prototype.postMessage;
  /** @type {string[]} */
  const seen = [];
  /** @type {(() => void)[]} */
  const waiting = [];
  let left = most;
  Worker.prototype.postMessage = /** @this {Worker} @param {any} message @param {any} transfer */ function (message, transfer) {
    const post = () => own.call(this, message, transfer);
    if (message?.type === 'call') seen.push(message.method);
    if (message?.method !== method) return post();
    waiting.push(post);
    allow(0);
  };
  const allow = (/** @type {number} */ more) => {
    left += more;
    for (; left > 0 && waiting.length > 0; left--) waiting.shift()?.();
  };
  const onPress = () => void seen.push(press);
  addEventListener('pointerdown', onPress, { capture: true });
  const letGo = () => {
    Worker.prototype.postMessage = own;
    removeEventListener('pointerdown', onPress, { capture: true });
    allow(waiting.length);
  };
  globalThis.callsOfWorkers = { seen, allow, letGo };
}
