/** Random work in a page with the demonstration, of which all is undone or left behind. */
import { atRest, until } from '../support/browser.mjs';
import { exportSheet, openExport, savedFile } from '../support/exporting.mjs';
import * as panel from '../support/panel.mjs';
import { Stage } from '../support/stage.mjs';
import { trueOutline } from '../support/study.mjs';
import * as tracing from '../support/tracing.mjs';

/** @typedef {import('playwright-core').Page} Page */

const FRAMES = 8;
const COMPONENTS = /** @type {const} */ (['femur', 'tibia']);

export class RandomWork {
  /** What there is to do. @type {Readonly<Record<string, () => Promise<void>>>} */
  kinds = {
    click: () => this.#click(),
    drag: () => this.#drag(),
    follow: () => this.#follow(),
    undo: () => this.#undo(),
    export: () => this.#export(),
    reload: () => this.#reload(),
    open: () => this.open(),
  };

  /** @param {Page} page @param {Page} other it is loaded anew again and again @param {() => number} random */
  constructor(page, other, random) {
    this.page = page;
    this.other = other;
    this.random = random;
  }

  /** A new work. Earlier ones stay. */
  async open() {
    await this.page.keyboard.press('Escape');
    await this.page.keyboard.press('Shift+Alt+n');
    await tracing.openDemonstration(this.page);
  }

  /** One click into a component of some frame. */
  async #click() {
    const component = COMPONENTS[Math.floor(this.random() * 2)];
    const frame = 1 + Math.floor(this.random() * FRAMES);
    await this.#goTo(frame, component);
    await this.page.keyboard.press('o');
    await atRest(this.page);
    const stage = new Stage(this.page);
    await stage.learn();
    await stage.click(tracing.insideOf(await trueOutline(component, frame)));
    await atRest(this.page);
  }

  /** A point of a traced outline, along and back. */
  async #drag() {
    await this.#goTo(1, 'femur');
    const stage = new Stage(this.page);
    const outline = await trueOutline('femur', 1);
    const isOpen = (await panel.cells(this.page)).some((cell) => /^Frame 1, femur: empty/.test(cell));
    await stage.learn();
    if (isOpen) await stage.trace(outline);
    await this.page.keyboard.press('e');
    await stage.learn();
    const [column, row] = outline[Math.floor(this.random() * outline.length)];
    await stage.drag([column, row], [column + 6 * this.random() - 3, row + 6 * this.random() - 3]);
    await atRest(this.page);
  }

  async #follow() {
    const cells = await panel.cells(this.page);
    if (!cells.some((cell) => /: (posed|followed)/.test(cell))) await this.#click();
    await this.page.keyboard.press('Shift+G');
    // Some are stopped on the way.
    if (this.random() < 0.3) {
      await this.page.waitForTimeout(1000 * this.random());
      await this.page.keyboard.press('Shift+G');
    }
    await until(() => this.page.getByRole('progressbar').count(), (count) => count === 0, 'the film to be followed');
    await atRest(this.page);
  }

  async #undo() {
    for (let step = Math.floor(8 * this.random()); step >= 0; step--) await this.page.keyboard.press('Control+z');
    await atRest(this.page);
    for (let step = Math.floor(3 * this.random()); step > 0; step--) await this.page.keyboard.press('Control+y');
    await atRest(this.page);
  }

  async #export() {
    const kinds = [['Session'], ['Poses', 'For commands'], ['Session', 'With images and models'], ['Session', 'Study file']];
    const [kind, ...choices] = kinds[Math.floor(this.random() * kinds.length)];
    const hasPoses = (await panel.cells(this.page)).some((cell) => /: (posed|followed)/.test(cell));
    if (kind === 'Poses' && !hasPoses) return;
    await openExport(this.page, kind, ...choices);
    await savedFile(this.page);
    // Who has saved a session is done; other files leave the sheet open.
    const sheet = exportSheet(this.page);
    if (await sheet.count()) await this.page.keyboard.press('Escape');
    await sheet.waitFor({ state: 'detached' });
  }

  /** Another page, which finds the work that is kept. */
  async #reload() {
    await this.other.goto(this.page.url());
    await until(() => this.other.evaluate(() => 'fluoropose' in globalThis), (here) => here, 'the other page to start');
    await atRest(this.other);
    await this.other.goto('about:blank');
    await this.page.bringToFront();
  }

  /** @param {number} frame @param {'femur' | 'tibia'} component */
  async #goTo(frame, component) {
    await this.page.getByRole('slider', { name: 'Frame', exact: true }).fill(String(frame - 1));
    await this.page.getByRole('radio', { name: component === 'femur' ? 'Femur' : 'Tibia' }).click();
  }
}
