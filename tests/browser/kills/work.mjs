/** Work done at random in a page, with every state that it went through: what a kill may bring back. */
import assert from 'node:assert/strict';
import { atRest, drawn, until } from '../support/browser.mjs';
import { exported } from '../support/exporting.mjs';
import { choose } from '../support/files.mjs';
import { greyAt, png, SIZE } from '../support/frames.mjs';
import * as panel from '../support/panel.mjs';
import { Stage } from '../support/stage.mjs';

/** @typedef {import('playwright-core').Page} Page */
/** @typedef {'femur' | 'tibia'} Component */
/** @typedef {{ points: number, closed: boolean, note: string, flagged: boolean }} CellState */
/** @typedef {{ name: string, frames: string[], cells: Record<string, CellState> }} State */
/** @typedef {() => number} Random */

const FRAMES = 3;
const EMPTY = { points: 0, closed: false, note: '', flagged: false };
/** Corners on the frame, px. @type {import('../support/study.mjs').Point[]} */
const CORNERS = [[5, 4], [18, 4], [18, 12], [5, 12]];
const PAUSES_MS = [0, 0, 60, 250, 450, 900];

export class Work {
  /** @param {Page} page @param {Random} random @param {string} title no other work has it */
  constructor(page, random, title) {
    this.page = page;
    this.random = random;
    this.title = title;
    /** @type {State[]} */
    this.states = [{ name: '', frames: [], cells: {} }];
    /** The latest state that the page showed as saved. */
    this.saved = 0;
    this.edits = 0;
    /** The cell in hand. */
    this.at = '';
    this.stage = new Stage(page);
  }

  /** Small frames with a name, kept. */
  async begin() {
    await this.open();
    await this.rest();
    return this;
  }

  /** The same, kept or not. */
  async open() {
    const names = Array.from({ length: FRAMES }, (_, index) => `${this.title} ${index}.png`);
    await choose(this.page, ...names.map(frameFile));
    await panel.waitForFrames(this.page, FRAMES);
    await this.page.keyboard.press('p');
    await this.stage.learn();
    await this.page.getByRole('textbox', { name: 'Name of the study' }).fill(this.title);
    this.#push({ name: this.title, frames: names });
    return this;
  }

  /** So many edits, with rests between them or none. @param {number} count */
  async edit(count) {
    for (let done = 0; done < count; done++) {
      await this.#one();
      this.edits++;
      await new Promise((resolve) => setTimeout(resolve, this.#pick(PAUSES_MS)));
      if (this.random() < 0.6) await this.look();
    }
  }

  /** What the page says of saving, of a moment when it shows all that was done. */
  async look() {
    const last = this.states.length - 1;
    await drawn(this.page);
    const said = await savedState(this.page);
    // Without a word the page says that nothing waits.
    if (said === '' || said.startsWith('Saved')) this.saved = last;
    return said;
  }

  /** Waits until the page shows all of it as saved. */
  async rest() {
    await panel.waitUntilKept(this.page);
    this.saved = this.states.length - 1;
  }

  /** The browser has cleared what it kept, and what was shown as saved went with it; it is safe again when the page shows it as saved again. */
  evicted() {
    this.saved = 0;
  }

  /** Another frame, of so many bytes or a little more. @param {number} bytes */
  async addFrame(bytes) {
    const { frames } = this.#last;
    const name = `${this.title} ${frames.length}.png`;
    const small = frameFile(name);
    // Bytes behind its end are no part of a picture, but of the file that is kept.
    const noise = Buffer.from(Array.from({ length: bytes }, () => Math.floor(this.random() * 256)));
    await choose(this.page, { ...small, buffer: Buffer.concat([small.buffer, noise]) });
    await panel.waitForFrames(this.page, frames.length + 1);
    this.#push({ frames: [...frames, name] });
  }

  /** The mouse goes down where an outline begins: on a point of it, or that makes the first. */
  async press() {
    await this.page.keyboard.press('e');
    await this.stage.hover(CORNERS[0]);
    await this.page.mouse.down();
    if (this.at) this.#pushCell(this.at, { points: Math.max(1, this.#last.cells[this.at]?.points ?? 0) });
  }

  /** Asserts that a page holds this work in a state that is no older than what was shown as saved, pixels too. @param {Page} page */
  async isIn(page) {
    const expected = this.states.slice(this.saved);
    if (this.saved === 0 && (await isEmpty(page))) return { unsaved: expected.length - 1, broughtBack: 0 };
    await until(() => page.getByRole('progressbar').count(), (count) => count === 0, 'the files to be back');
    await atRest(page);
    const session = JSON.parse((await exported(page, 'Session')).buffer.toString());
    const found = stateOf(session.document);
    const at = expected.findIndex((state) => same(state, found));
    if (at < 0) {
      const older = this.states.findIndex((state) => same(state, found));
      const words = older < 0 ? 'a state in which it never was' : `state ${older}, before state ${this.saved}, which was shown as saved`;
      assert.fail(`the work came back in ${words}: ${JSON.stringify(found)} instead of ${JSON.stringify(expected.at(-1))}`);
    }
    const missing = session.files.filter((/** @type {{ name: string, base64: string | null }} */ { base64 }) => base64 === null);
    const safe = this.states[this.saved].frames;
    assert.deepEqual(missing.filter(({ name }) => safe.includes(name)), [], 'files of the work are gone');
    await showsPixels(page, this.title, safe.length);
    return { unsaved: expected.length - 1, broughtBack: at };
  }

  get #last() {
    return /** @type {State} */ (this.states.at(-1));
  }

  /** @param {Partial<State>} change */
  #push(change) {
    this.states.push({ ...this.#last, ...change });
  }

  /** @param {string} cell @param {Partial<CellState>} change */
  #pushCell(cell, change) {
    const cells = { ...this.#last.cells, [cell]: { ...EMPTY, ...this.#last.cells[cell], ...change } };
    this.#push({ cells });
  }

  /** @template T @param {readonly T[]} all @returns {T} */
  #pick(all) {
    return all[Math.floor(this.random() * all.length)];
  }

  async #one() {
    const frame = 1 + Math.floor(this.random() * FRAMES);
    const component = this.#pick(/** @type {Component[]} */ (['femur', 'tibia']));
    const key = `${frame}/${component}`;
    const button = this.page.getByRole('table', { name: 'Frames and components' }).getByRole('button', { name: new RegExp(`^Frame ${frame}, ${component}:`) });
    await button.click();
    this.at = key;
    const kind = this.random();
    if (kind < 0.35) return this.#note(key, frame, component);
    if (kind < 0.5) return this.#flag(key);
    if (kind < 0.65) return this.#name();
    return this.#trace(key);
  }

  /** @param {string} key @param {number} frame @param {Component} component */
  async #note(key, frame, component) {
    const note = `${this.title}, note ${this.states.length}`;
    const field = this.page.getByRole('textbox', { name: `Note on frame ${frame}, ${component}` });
    await field.fill(note);
    this.#pushCell(key, { note });
    await field.blur();
  }

  /** @param {string} key */
  async #flag(key) {
    await this.page.getByRole('button', { name: 'Flag', exact: true }).click();
    this.#pushCell(key, { flagged: !this.#last.cells[key]?.flagged });
  }

  async #name() {
    const name = `${this.title}, ${this.states.length}`;
    const field = this.page.getByRole('textbox', { name: 'Name of the study' });
    await field.fill(name);
    this.#push({ name });
    await field.blur();
  }

  /** The next points of an outline, and its end. @param {string} key */
  async #trace(key) {
    const { points, closed } = this.#last.cells[key] ?? EMPTY;
    if (closed) return;
    await this.page.keyboard.press('p');
    const clicks = 1 + Math.floor(this.random() * 4);
    for (let at = points; at < Math.min(points + clicks, CORNERS.length); at++) {
      await this.stage.click(CORNERS[at]);
      this.#pushCell(key, { points: at + 1 });
    }
    if (points + clicks <= CORNERS.length) return;
    await this.page.keyboard.press('Enter');
    this.#pushCell(key, { closed: true });
  }
}

/** @param {Page} page */
export function savedState(page) {
  return page.getByRole('group', { name: 'Saved state' }).innerText();
}

/** The page that nothing came back into. @param {Page} page */
async function isEmpty(page) {
  const opening = page.getByRole('button', { name: 'Open the demonstration' });
  await opening.or(page.getByRole('slider', { name: 'Frame', exact: true })).first().waitFor();
  await atRest(page);
  return (await opening.count()) > 0;
}

/** No two alike, of no two works. @param {string} name */
function frameFile(name) {
  return { ...png(8, (grey) => (grey + shiftOf(name)) % 256), name };
}

/** @param {string} name */
function shiftOf(name) {
  return [...name].reduce((sum, letter) => (31 * sum + letter.charCodeAt(0)) % 251, 0);
}

/** What a document holds of all this. @param {any} document @returns {State} */
function stateOf(document) {
  /** @type {Record<string, CellState>} */
  const cells = {};
  document.frames.forEach((/** @type {{ id: string }} */ { id }, /** @type {number} */ index) => {
    for (const component of ['femur', 'tibia']) {
      const outline = document.cells[`${id}/${component}`]?.outline;
      const mark = document.marks[`${id}/${component}`];
      if (!outline && !mark) continue;
      cells[`${index + 1}/${component}`] = {
        points: outline?.points.length ?? 0,
        closed: outline?.closed ?? false,
        note: mark?.note ?? '',
        flagged: mark?.flagged ?? false,
      };
    }
  });
  return { name: document.name, frames: document.frames.map((/** @type {{ name: string }} */ { name }) => name), cells };
}

/** @param {State} a @param {State} b */
function same(a, b) {
  return canonical(a) === canonical(b);
}

/** @param {State} state */
function canonical({ name, frames, cells }) {
  const held = Object.entries(cells).filter(([, cell]) => JSON.stringify(cell) !== JSON.stringify(EMPTY));
  return JSON.stringify([name, frames, held.sort(([a], [b]) => (a < b ? -1 : 1))]);
}

/** The grey value under the mouse is that of the file. @param {Page} page @param {string} title @param {number} frames */
async function showsPixels(page, title, frames) {
  if (frames === 0) return;
  const slider = page.getByRole('slider', { name: 'Frame', exact: true });
  for (const index of [0, frames - 1]) {
    await slider.fill(String(index));
    await page.getByRole('application', { name: new RegExp(`frame ${index + 1} of`) }).waitFor();
    const stage = new Stage(page);
    await stage.learn();
    await stage.hover([SIZE.width / 2 + 0.5, SIZE.height / 2 + 0.5]);
    const status = page.getByRole('contentinfo', { name: 'Status' });
    const text = await until(() => status.innerText(), (words) => / px · \d+/.test(words), `frame ${index + 1} to have its grey values`);
    const [, column, row, grey] = /(-?\d+\.\d), (-?\d+\.\d) px · (\d+)/.exec(text) ?? [];
    const written = greyAt(Math.floor(Number(column)), Math.floor(Number(row))) + shiftOf(`${title} ${index}.png`);
    assert.equal(Number(grey), written % 256, `grey value of frame ${index + 1}`);
  }
}
