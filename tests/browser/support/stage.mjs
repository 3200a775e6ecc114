/** The frame and a hand with a mouse on it. Points are columns and rows of the frame, as in the page's readout. */
import assert from 'node:assert/strict';
import { AS_IT_IS, atRest, drawn, until } from './browser.mjs';

/** @typedef {import('./study.mjs').Point} Point */

/** From a corner of the canvas inwards, CSS px, so that the mouse surely is over it. */
const INSET = 8;
/** The readout's last decimal, px. */
const TENTH = 0.1;
/** Fraction of the canvas that a zoomed outline fills. */
const FILL = 0.85;
/** What one notch of the page's zoom multiplies by is `2 ** (NOTCH / 300)`. */
const NOTCH = 100;

export class Stage {
  /** @param {import('playwright-core').Page} page */
  constructor(page) {
    this.page = page;
    this.canvas = page.getByRole('application', { name: /outline$/ });
    /** How the frame lies on the page: `page = frame * scale + (left, top)`. */
    this.view = { scale: NaN, left: NaN, top: NaN };
  }

  async box() {
    const box = await this.canvas.boundingBox();
    assert(box, 'the frame is not visible');
    return box;
  }

  /** Where the mouse is on the frame, as the status line says it to a tenth of a pixel. @returns {Promise<Point>} */
  async readout() {
    await drawn(this.page);
    const status = this.page.getByRole('contentinfo', { name: 'Status' });
    const place = /(-?\d+\.\d), (-?\d+\.\d) px/;
    // A page that has just come back says first that it has.
    const text = await until(() => status.innerText(), (words) => place.test(words), 'the status line to say where the mouse is');
    const found = place.exec(text);
    assert(found);
    return [Number(found[1]), Number(found[2])];
  }

  /** The grey value at a place, as the status line says it once the frame is there. @param {Point} place */
  async greyAt(place) {
    await this.hover(place);
    await drawn(this.page);
    const status = this.page.getByRole('contentinfo', { name: 'Status' });
    const grey = / px · (\d+)/;
    const text = await until(() => status.innerText(), (words) => grey.test(words), `a grey value at ${place}`);
    return Number(grey.exec(text)?.[1]);
  }

  /** Finds out how the frame lies on the page from the readout at two corners. */
  async learn() {
    const { x, y, width, height } = await this.box();
    const [left, top, right, bottom] = [x + INSET, y + INSET, x + width - INSET, y + height - INSET].map(Math.round);
    await this.page.mouse.move(left, top);
    const [column0, row0] = await this.readout();
    await this.page.mouse.move(right, bottom);
    const [column1, row1] = await this.readout();
    const scale = (right - left) / (column1 - column0);
    const down = (bottom - top) / (row1 - row0);
    // Both spans are rounded at both ends.
    const doubt = TENTH / (column1 - column0) + TENTH / (row1 - row0);
    assert(Math.abs(scale / down - 1) <= doubt, `the frame is stretched: ${scale} across, ${down} down`);
    this.view = { scale, left: left - column0 * scale, top: top - row0 * scale };
  }

  /** Whole pixels, as a mouse has them. @param {Point} point @returns {[number, number]} */
  toPage([column, row]) {
    const { scale, left, top } = this.view;
    return [Math.round(column * scale + left), Math.round(row * scale + top)];
  }

  /** @param {Point} point */
  async hover(point) {
    await this.page.mouse.move(...this.toPage(point));
  }

  /** @param {Point} point */
  async click(point) {
    await this.page.mouse.click(...this.toPage(point));
  }

  /** @param {Point} from @param {Point} to @param {'left' | 'middle' | 'right'} [button] */
  async drag(from, to, button = 'left') {
    await this.hover(from);
    await this.page.mouse.down({ button });
    await this.page.mouse.move(...this.toPage(to), { steps: 5 });
    await this.page.mouse.up({ button });
  }

  /** Wheel and middle button, until the points fill the canvas. @param {Point[]} points */
  async zoomTo(points) {
    await this.learn();
    const { x, y, width, height } = await this.box();
    const [least, most] = [Math.min, Math.max].map((pick) => [0, 1].map((axis) => pick(...points.map((p) => p[axis]))));
    const middle = /** @type {Point} */ ([(least[0] + most[0]) / 2, (least[1] + most[1]) / 2]);
    const wanted = FILL * Math.min(width / (most[0] - least[0]), height / (most[1] - least[1]));
    await this.hover(middle);
    const notches = Math.floor((300 * Math.log2(wanted / this.view.scale)) / NOTCH);
    for (let notch = 0; notch < notches; notch++) await this.page.mouse.wheel(0, -NOTCH);
    await this.learn();
    const { scale, left, top } = this.view;
    const centre = /** @type {Point} */ ([(x + width / 2 - left) / scale, (y + height / 2 - top) / scale]);
    await this.drag(middle, centre, 'middle');
    await this.learn();
  }

  /** With the tool that traces by hand: clicks around the points and closes with a click on the first. @param {Point[]} points */
  async trace(points) {
    await this.page.keyboard.press('p');
    for (const point of points) await this.click(point);
    await this.click(points[0]);
  }

  /** What the frame and everything on it come to look like with the mouse elsewhere, but for the ring of the keyboard's focus. */
  async picture() {
    await this.page.mouse.move(1, 1);
    await atRest(this.page);
    const { x, y, width, height } = await this.box();
    const clip = { x: x + INSET, y: y + INSET, width: width - 2 * INSET, height: height - 2 * INSET };
    return this.page.screenshot({ ...AS_IT_IS, clip });
  }

  /** Waits until the frame looks otherwise than in a picture taken before, and gives what it looks like. @param {Buffer} before @param {string} what */
  looksOtherwise(before, what) {
    return until(() => this.picture(), (picture) => !before.equals(picture), what);
  }

  /** Waits until the frame looks as in a picture taken before. @param {Buffer} before @param {string} what */
  async looksLike(before, what) {
    await until(async () => before.equals(await this.picture()), (same) => same, `${what} to look as before`);
  }
}
