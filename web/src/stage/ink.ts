import type { CanvasPoint } from '../geometry/points';
import type { Size } from '../geometry/viewport';
import type { Box } from '../films/studio';

/** Beyond the points of what is drawn: handles, halos, the reach of a line's corner. CSS px. */
const MARGIN = 16;
/** Sides are whole multiples of this: while something moves, the canvas seldom changes its size. CSS px. */
const STEP = 64;

/**
 * The canvas for what is drawn over the frame, no larger than that: without a graphics card every pixel of it is cleared,
 * copied and laid over the frame in each screen frame.
 */
export class Ink {
  readonly #canvas: HTMLCanvasElement;
  #box = '';

  constructor(canvas: HTMLCanvasElement) {
    this.#canvas = canvas;
  }

  /** Empty, and scaled so that one unit is one CSS pixel of the stage; what lies outside of the box is not drawn. */
  begin(box: Box): CanvasRenderingContext2D {
    const ratio = window.devicePixelRatio || 1;
    const { left, top, width, height } = box;
    const key = [left, top, width, height, ratio].join();
    if (key !== this.#box) this.#place(box, ratio);
    this.#box = key;
    const context = this.#canvas.getContext('2d');
    if (!context) throw new Error('this browser has no 2-D canvas');
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.#canvas.width, this.#canvas.height);
    context.setTransform(ratio, 0, 0, ratio, -left * ratio, -top * ratio);
    return context;
  }

  #place({ left, top, width, height }: Box, ratio: number): void {
    const { style } = this.#canvas;
    [style.left, style.top, style.width, style.height] = [left, top, width, height].map((length) => `${length}px`) as [string, string, string, string];
    const [across, down] = [Math.round(width * ratio), Math.round(height * ratio)];
    // To set a size, even the same, costs a new canvas.
    if (this.#canvas.width !== across) this.#canvas.width = across;
    if (this.#canvas.height !== down) this.#canvas.height = down;
  }
}

/** The part of the stage that some points are in, with room for what is drawn around them. */
export function boxRound(points: Iterable<CanvasPoint>, stage: Size): Box {
  let [left, top, right, bottom] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const { x, y } of points) {
    left = Math.min(left, x);
    right = Math.max(right, x);
    top = Math.min(top, y);
    bottom = Math.max(bottom, y);
  }
  const [first, width] = span(left, right, stage.width);
  const [upper, height] = span(top, bottom, stage.height);
  return { left: first, top: upper, width, height };
}

/** Where it begins and how long it is. */
function span(low: number, high: number, room: number): [number, number] {
  const begin = clamp(Math.floor((low - MARGIN) / STEP) * STEP, room);
  const end = clamp(Math.ceil((high + MARGIN) / STEP) * STEP, room);
  return end > begin ? [begin, end - begin] : [0, 1];
}

function clamp(at: number, room: number): number {
  return Math.min(Math.max(at, 0), Math.ceil(room));
}
