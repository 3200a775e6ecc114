import { formatNumber } from '../../texts/numbers';
import type { ShownFrame } from './overlay_frames';
import type { OverlayCurve, OverlayFrame, OverlayLine, OverlayLook } from '../protocol/overlay';

type Context = OffscreenCanvasRenderingContext2D;

interface Box {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

const INK = { ground: '#16181a', text: '#e4e7ea', quiet: '#9aa1a8', line: '#33373c' } as const;
const FONT = 'system-ui, -apple-system, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif';
/** Rows of the picture: frames that are larger are drawn smaller, much smaller ones larger. */
const ROWS = { least: 480, most: 1080 } as const;
/** Width of what stands beside the frame, and its heading's height, as parts of the picture's height. */
const BESIDE = 0.56;
const HEADING = 0.16;
/** Size of the lines that say why a frame is doubtful, percent of the picture's height, and how many there may be. */
const NOTE = 1.6;
const NOTES = 4;

/** Draws the pictures of one film: what all have in common is drawn once. */
export class OverlayDrawing {
  readonly canvas: OffscreenCanvas;
  readonly #context: Context;
  readonly #look: OverlayLook;
  /** Px of the picture for one of the frame. */
  readonly #scale: number;
  readonly #plots: readonly Plot[];
  readonly #still: OffscreenCanvas;

  constructor(look: OverlayLook) {
    const height = even(Math.min(ROWS.most, Math.max(ROWS.least, look.height)));
    this.#look = look;
    this.#scale = height / look.height;
    const across = even(look.width * this.#scale);
    const width = across + even(BESIDE * height);
    this.canvas = new OffscreenCanvas(width, height);
    this.#context = contextOf(this.canvas);
    const unit = height / 100;
    const beside = { left: across + 3 * unit, top: HEADING * height, width: width - across - 6 * unit, height: (1 - HEADING) * height - 2 * unit };
    const each = beside.height / Math.max(1, look.curves.length);
    this.#plots = look.curves.map((curve, at) => new Plot(curve, look.frames, { ...beside, top: beside.top + at * each, height: each }, unit));
    this.#still = new OffscreenCanvas(width, height);
    const still = contextOf(this.#still);
    still.fillStyle = INK.ground;
    still.fillRect(0, 0, width, height);
    for (const plot of this.#plots) plot.drawStill(still);
    if (look.curves.length === 0) words(still, look.noCurves, beside.left, beside.top + 3 * unit, { size: 2.2 * unit, colour: INK.quiet, width: beside.width });
  }

  draw({ index, heading, time, notes }: OverlayFrame, { picture, outlines }: ShownFrame): void {
    const context = this.#context;
    const { width, height } = this.#look;
    context.drawImage(this.#still, 0, 0);
    context.drawImage(picture, 0, 0, width * this.#scale, height * this.#scale);
    for (const { corners, colour } of outlines) this.#drawOutline(corners, colour);
    for (const plot of this.#plots) plot.drawHere(context, index);
    this.#drawHeading(heading, time, notes);
  }

  /** With a dark line below it: the frame may be as bright as it is. Nothing of it lies beside the frame. */
  #drawOutline(corners: Float64Array, colour: string): void {
    const context = this.#context;
    const { width, height } = this.#look;
    context.save();
    context.scale(this.#scale, this.#scale);
    context.beginPath();
    context.rect(0, 0, width, height);
    context.clip();
    context.beginPath();
    for (let i = 0; i + 1 < corners.length; i += 2) context.lineTo(corners[i]!, corners[i + 1]!);
    context.closePath();
    context.lineJoin = 'round';
    for (const [style, line] of [['rgb(0 0 0 / 0.5)', 3.6], [colour, 1.8]] as const) {
      context.strokeStyle = style;
      context.lineWidth = line / this.#scale;
      context.stroke();
    }
    context.restore();
  }

  #drawHeading(heading: string, time: string, notes: readonly string[]): void {
    const { canvas, height } = { canvas: this.canvas, height: this.canvas.height };
    const unit = height / 100;
    const left = even(this.#look.width * this.#scale) + 3 * unit;
    const width = canvas.width - left - 3 * unit;
    words(this.#context, this.#look.name, left, 3.4 * unit, { size: 2 * unit, colour: INK.quiet, width });
    words(this.#context, heading, left, 7.2 * unit, { size: 3.2 * unit, colour: INK.text, width: time ? 0.7 * width : width });
    if (time) words(this.#context, time, left + width, 7.2 * unit, { size: 2.4 * unit, colour: INK.text, width: 0.28 * width, align: 'right' });
    const size = NOTE * unit;
    this.#context.font = `${size}px ${FONT}`;
    const lines = notes.flatMap((note) => broken(note, (text) => this.#context.measureText(text).width <= width));
    const shown = lines.length > NOTES ? [...lines.slice(0, NOTES - 1), `${lines[NOTES - 1]}\u2026`] : lines;
    shown.forEach((line, at) => words(this.#context, line, left, (10 + 1.8 * at) * unit, { size, colour: INK.quiet, width }));
  }
}

/** A curve with its axis, and where it is now. */
class Plot {
  readonly #area: Box;
  readonly #low: number;
  readonly #high: number;

  constructor(
    readonly curve: OverlayCurve,
    readonly frames: number,
    readonly box: Box,
    readonly unit: number,
  ) {
    const { left, top, width, height } = box;
    this.#area = { left: left + 7 * unit, top: top + 4 * unit, width: width - 7 * unit, height: height - 6.5 * unit };
    [this.#low, this.#high] = rangeOf(curve.lines);
  }

  drawStill(context: Context): void {
    const { curve, box, unit } = this;
    const area = this.#area;
    words(context, `${curve.title} (${curve.unit})`, box.left, box.top + 2.4 * unit, { size: 2 * unit, colour: INK.text, width: box.width });
    context.lineWidth = Math.max(1, 0.12 * unit);
    for (const mark of marksOf(this.#low, this.#high)) {
      const y = this.#row(mark);
      context.strokeStyle = INK.line;
      context.beginPath();
      context.moveTo(area.left, y);
      context.lineTo(area.left + area.width, y);
      context.stroke();
      words(context, String(mark).replace('-', '\u2212'), area.left - unit, y + 0.6 * unit, { size: 1.7 * unit, colour: INK.quiet, width: 6 * unit, align: 'right' });
    }
    const below = area.top + area.height + 1.9 * unit;
    words(context, '1', area.left, below, { size: 1.6 * unit, colour: INK.quiet, width: 6 * unit });
    words(context, String(this.frames), area.left + area.width, below, { size: 1.6 * unit, colour: INK.quiet, width: 6 * unit, align: 'right' });
    for (const line of curve.lines) this.#drawLine(context, line);
  }

  /** Where the film is, and the numbers there, in the colours of their lines. */
  drawHere(context: Context, index: number): void {
    const { curve, box, unit } = this;
    const area = this.#area;
    const x = this.#column(index);
    context.strokeStyle = INK.quiet;
    context.lineWidth = Math.max(1, 0.12 * unit);
    context.beginPath();
    context.moveTo(x, area.top);
    context.lineTo(x, area.top + area.height);
    context.stroke();
    let right = box.left + box.width;
    for (const { values, colour, label } of [...curve.lines].reverse()) {
      const value = values[index] ?? NaN;
      const shown = Number.isFinite(value) ? formatNumber(value, 1) : '\u2013';
      const text = label ? `${label} ${shown}` : shown;
      words(context, text, right, box.top + 2.4 * unit, { size: 2 * unit, colour, width: 0.4 * box.width, align: 'right' });
      right -= context.measureText(text).width + 2 * unit;
      if (!Number.isFinite(value)) continue;
      context.fillStyle = colour;
      context.beginPath();
      context.arc(x, this.#row(value), 0.7 * unit, 0, 2 * Math.PI);
      context.fill();
    }
  }

  /** A band of one standard deviation below the line; nothing across a gap. */
  #drawLine(context: Context, { values, deviations, colour }: OverlayLine): void {
    context.save();
    context.beginPath();
    context.rect(this.#area.left, this.#area.top, this.#area.width, this.#area.height);
    context.clip();
    context.fillStyle = context.strokeStyle = colour;
    context.lineJoin = 'round';
    context.lineWidth = 0.25 * this.unit;
    for (const [first, last] of runsOf(values)) {
      const at = (index: number, sign: number): [number, number] => [this.#column(index), this.#row(values[index]! + sign * (deviations[index] || 0))];
      context.beginPath();
      for (let index = first; index <= last; index++) context.lineTo(...at(index, 1));
      for (let index = last; index >= first; index--) context.lineTo(...at(index, -1));
      context.closePath();
      context.globalAlpha = 0.22;
      context.fill();
      context.globalAlpha = 1;
      context.beginPath();
      for (let index = first; index <= last; index++) context.lineTo(...at(index, 0));
      // A frame by itself has no length.
      if (first === last) context.arc(...at(first, 0), 0.25 * this.unit, 0, 2 * Math.PI);
      context.stroke();
    }
    context.restore();
  }

  #column(index: number): number {
    return this.#area.left + (this.frames > 1 ? index / (this.frames - 1) : 0.5) * this.#area.width;
  }

  #row(value: number): number {
    return this.#area.top + (1 - (value - this.#low) / (this.#high - this.#low)) * this.#area.height;
  }
}

/** First and last of the frames in a row that have a number. */
export function runsOf(values: ArrayLike<number>): [number, number][] {
  const runs: [number, number][] = [];
  for (let index = 0; index < values.length; index++) {
    if (!Number.isFinite(values[index])) continue;
    const run = runs.at(-1);
    if (run && run[1] === index - 1) run[1] = index;
    else runs.push([index, index]);
  }
  return runs;
}

/** From the least number to the most, with a margin; what hardly changes is drawn flat. */
export function rangeOf(lines: readonly Pick<OverlayLine, 'values'>[]): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const { values } of lines) {
    for (const value of values) {
      if (!Number.isFinite(value)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  if (low > high) return [0, 1];
  const [middle, span] = [(low + high) / 2, Math.max(2, 1.2 * (high - low))];
  return [middle - span / 2, middle + span / 2];
}

/** Three or four round numbers. */
export function marksOf(low: number, high: number): number[] {
  const least = (high - low) / 4;
  const power = 10 ** Math.floor(Math.log10(least));
  const step = power * ([1, 2, 5, 10].find((one) => one * power >= 0.999 * least) ?? 10);
  const first = Math.ceil(low / step);
  const count = Math.floor(high / step) - first + 1;
  return Array.from({ length: count }, (_, at) => Number(((first + at) * step).toFixed(6)) || 0);
}

interface Style {
  readonly size: number;
  readonly colour: string;
  readonly width: number;
  readonly align?: 'left' | 'right';
}

/** A text as lines that fit, broken between words. */
function broken(text: string, fits: (line: string) => boolean): readonly string[] {
  const lines: string[] = [];
  for (const word of text.split(/\s+/).filter(Boolean)) {
    const line = `${lines.at(-1) ?? ''} ${word}`.trimStart();
    if (lines.length > 0 && fits(line)) lines[lines.length - 1] = line;
    else lines.push(word);
  }
  return lines;
}

/** Words that are too long for their place are cut. */
function words(context: Context, text: string, x: number, y: number, { size, colour, width, align = 'left' }: Style): void {
  context.font = `${size}px ${FONT}`;
  context.fillStyle = colour;
  context.textAlign = align;
  let shown = text;
  while (shown.length > 1 && context.measureText(shown).width > width) shown = `${shown.slice(0, -2)}\u2026`;
  context.fillText(shown, x, y);
}

function contextOf(canvas: OffscreenCanvas): Context {
  const context = canvas.getContext('2d');
  if (!context) throw new Error('this browser has no 2-D canvas');
  return context;
}

/** Films have even sides. */
function even(value: number): number {
  return 2 * Math.round(value / 2);
}
