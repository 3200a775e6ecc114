import { describe, expect, it } from 'vitest';
import * as history from '../../src/document/history';
import { cellOf, EMPTY_DOC, type Outline } from '../../src/document/types';
import type { Command } from '../../src/document/command';
import { addPoint } from '../../src/document/commands';
import type { CoolingPixels, Region, WirePixels } from '../../src/tracing/pixels';
import { Threshold } from '../../src/tracing/threshold';
import { Wire } from '../../src/tracing/wire';
import { framePoint, type FramePoint } from '../../src/geometry/points';

const PLACE = { frameId: 'f', component: 'femur' } as const;
const at = framePoint;

/** The page with one cell. */
class Page {
  history = history.startHistory(EMPTY_DOC);
  place = PLACE;
  radius = 3;
  cooling = true;
  level: number | null = null;
  bridge = 0;
  time = 0;
  sides: number[] = [];
  sentences: string[] = [];

  get outline(): Outline | null {
    return cellOf(this.history.present, 'f', 'femur').outline;
  }

  get columns(): number[] {
    return this.outline?.points.map(({ column }) => column) ?? [];
  }

  perform(command: Command): void {
    this.history = history.perform(this.history, command);
  }

  undo(): void {
    this.history = history.undo(this.history);
  }

  redo(): void {
    this.history = history.redo(this.history);
  }

  say(sentence: string): void {
    this.sentences.push(sentence);
  }

  now(): number {
    return this.time;
  }

  /** The ends and nothing between. */
  refined(path: readonly FramePoint[], side: number): readonly FramePoint[] {
    this.sides.push(side);
    return [path[0]!, path.at(-1)!];
  }
}

/** Paths run along a row in steps of a pixel; the tree reaches everything after `needed` slices. */
class Pixels implements WirePixels {
  rows = 0;
  seeds: [number, number, number][] = [];
  slices = 0;
  needed = 0;
  common = 0;
  dark = 1;
  freed = false;

  prepare(rows: number): boolean {
    this.rows += rows;
    return this.rows >= 64;
  }

  snapPoint(column: number, row: number): Float64Array {
    return Float64Array.of(column + 1, row);
  }

  seed(column: number, row: number, side: number): void {
    if (this.rows < 64) throw new Error('not prepared');
    this.seeds.push([column, row, side]);
    this.slices = 0;
  }

  expand(): boolean {
    return ++this.slices > this.needed;
  }

  follow(column: number, row: number, _radius: number, pixels = 2 ** 31): Float64Array {
    if (pixels > 1e6) this.slices = this.needed + 1;
    if (this.slices < this.needed) return new Float64Array();
    const [from] = this.seeds.at(-1)!;
    const steps = Math.max(1, Math.abs(Math.round(column - from)));
    return Float64Array.from(Array.from({ length: steps + 1 }, (_, step) => [from + Math.sign(column - from) * step, row]).flat());
  }

  darkSide(): number {
    return this.dark;
  }

  free(): void {
    this.freed = true;
  }
}

/** Says that so many points are settled. */
class Cooler implements CoolingPixels {
  settled = 0;
  restarts = 0;
  clocks: number[] = [];

  restart(): void {
    this.restarts++;
  }

  observe(now: number): number {
    this.clocks.push(now);
    return this.settled;
  }
}

function bench() {
  const page = new Page();
  const pixels = new Pixels();
  const cooler = new Cooler();
  return { page, pixels, cooler, wire: new Wire(pixels, cooler, page) };
}

describe('the live-wire', () => {
  it('begins on the edge, follows, fixes, and closes along the edge', () => {
    const { page, pixels, wire } = bench();
    wire.fix(at(10, 50), false);
    expect(page.columns).toEqual([11]);
    wire.fix(at(60, 50), false);
    wire.fix(at(100, 90), false);
    expect(page.columns).toEqual([11, 60, 100]);
    expect(wire.close()).toBe(true);
    expect(page.outline?.closed).toBe(true);
    expect(page.history.past.map(({ label }) => label)).toEqual(['begin the outline', 'follow the edge', 'follow the edge', 'close the outline']);
    expect(pixels.seeds.map(([column]) => column)).toEqual([11, 60, 100]);
  });

  it('learns on which hand the implant is, and forgets it with the stretch that told', () => {
    const { page, pixels, wire } = bench();
    pixels.dark = -0.9;
    wire.fix(at(10, 50), false);
    wire.fix(at(60, 50), false);
    expect(pixels.seeds.at(-1)).toEqual([60, 50, -1]);
    expect(page.sides).toEqual([-1]);
    wire.takeBack();
    expect(pixels.seeds.at(-1)).toEqual([11, 50, 0]);
  });

  it('shows the path only when the tree reaches the pointer, and the last one until then', () => {
    const { page, pixels, wire } = bench();
    wire.fix(at(10, 50), false);
    pixels.needed = 3;
    pixels.slices = 0;
    wire.aim(at(40, 50), false);
    expect(wire.preview.kind).toBe('nothing');
    page.time = 0;
    // A slice a tick: time stands still within one.
    const slow = () => {
      page.now = () => (page.time += 4);
    };
    slow();
    expect(wire.tick(6)).toBe(true);
    while (wire.tick(6));
    expect(wire.preview).toMatchObject({ kind: 'path' });
  });

  it('goes straight where Shift is held', () => {
    const { page, wire } = bench();
    wire.fix(at(10, 50), true);
    expect(page.columns).toEqual([10]);
    wire.aim(at(33.3, 70.1), true);
    expect(wire.preview).toEqual({ kind: 'path', points: [at(10, 50), at(33.3, 70.1)] });
    wire.fix(at(33.3, 70.1), true);
    expect(page.columns).toEqual([10, 33.3]);
  });

  it('takes a second click on one spot for the same', () => {
    const { page, wire } = bench();
    wire.fix(at(10, 50), false);
    wire.fix(at(60, 50), false);
    wire.fix(at(60.5, 50.5), false);
    expect(page.columns).toEqual([11, 60]);
  });

  it('takes stretches back one by one, and undo brings each again', () => {
    const { page, wire } = bench();
    for (const column of [10, 60, 110]) wire.fix(at(column, 50), false);
    expect(wire.takeBack()).toBe(true);
    expect(page.columns).toEqual([11, 60]);
    wire.takeBack();
    wire.takeBack();
    expect(page.outline).toBeNull();
    expect(wire.takeBack()).toBe(false);
    for (let step = 0; step < 3; step++) page.undo();
    expect(page.columns).toEqual([11, 60, 110]);
    expect(wire.takeBack()).toBe(true);
    expect(page.columns).toEqual([11, 60]);
  });

  it('goes on from wherever undo, redo or another tool left the draft', () => {
    const { page, pixels, wire } = bench();
    for (const column of [10, 60, 110]) wire.fix(at(column, 50), false);
    page.undo();
    wire.aim(at(80, 50), false);
    wire.tick(6);
    expect(pixels.seeds.at(-1)![0]).toBe(60);
    page.redo();
    wire.tick(6);
    expect(pixels.seeds.at(-1)![0]).toBe(110);
    page.perform(addPoint(PLACE, at(200, 50)));
    wire.fix(at(240, 50), false);
    expect(page.columns).toEqual([11, 60, 110, 200, 240]);
    expect(pixels.seeds.at(-1)![0]).toBe(240);
  });

  it('fixes what has rested while the hand moved, and Backspace takes that back', () => {
    const { page, cooler, wire } = bench();
    wire.fix(at(10, 50), false);
    cooler.settled = 40;
    wire.aim(at(90, 50), false);
    wire.tick(6);
    expect(page.columns).toEqual([11, 50]);
    cooler.settled = 0;
    wire.takeBack();
    expect(page.columns).toEqual([11]);
  });

  it('leaves the hand a piece of the path, and cools nothing where that is switched off', () => {
    const { page, cooler, wire } = bench();
    wire.fix(at(10, 50), false);
    cooler.settled = 40;
    wire.aim(at(50, 50), false);
    wire.tick(6);
    expect(page.columns).toEqual([11]);
    page.cooling = false;
    wire.aim(at(90, 50), false);
    wire.tick(6);
    expect(page.columns).toEqual([11]);
  });

  it('does not take a pause for rest', () => {
    const { page, cooler, wire } = bench();
    wire.fix(at(10, 50), false);
    wire.aim(at(50, 50), false);
    wire.tick(6);
    page.time = 10_000;
    wire.aim(at(51, 50), false);
    wire.tick(6);
    const [before = 0, after = 0] = cooler.clocks.slice(-2);
    expect(after - before).toBeLessThanOrEqual(100);
  });

  it('goes straight to where no edge can be followed', () => {
    const { page, pixels, wire } = bench();
    wire.fix(at(10, 50), false);
    pixels.follow = () => new Float64Array();
    wire.fix(at(-5, 50), false);
    expect(page.columns).toEqual([11, -5]);
    expect(page.history.past.at(-1)?.label).toBe('draw a straight stretch');
  });

  it('has nothing to close or to take back without a draft', () => {
    const { wire } = bench();
    expect(wire.close()).toBe(false);
    expect(wire.takeBack()).toBe(false);
    wire.fix(at(10, 50), false);
    expect(wire.close()).toBe(false);
  });
});

/** A square of the size of its level around the place; nothing below 10. */
function region(): Region {
  return {
    least: 0,
    greatest: 200,
    suggest: ({ column }) => (column > 400 ? null : 50),
    outline: ({ column, row }, level) => (level < 10 ? [] : [at(column, row), at(column + level, row), at(column, row + level)]),
    free: () => undefined,
  };
}

describe('the threshold', () => {
  it('shows the region under the pointer at the level that suits it', () => {
    const page = new Page();
    const threshold = new Threshold(region(), page);
    threshold.aim(at(100, 100));
    threshold.tick();
    expect(threshold.preview).toMatchObject({ kind: 'ring', points: [{ column: 100 }, { column: 150 }, { column: 100 }] });
    page.level = 80;
    threshold.aim(at(100, 100));
    threshold.tick();
    expect(threshold.preview).toMatchObject({ points: [{ column: 100 }, { column: 180 }, { column: 100 }] });
    threshold.leave();
    expect(threshold.preview.kind).toBe('nothing');
    expect(page.outline).toBeNull();
  });

  it('takes it, and moving the level afterwards is the same unit of undo', () => {
    const page = new Page();
    const threshold = new Threshold(region(), page);
    threshold.take(at(100, 100));
    expect(page.columns).toEqual([100, 150, 100]);
    threshold.setLevel(60);
    threshold.drag(80);
    expect(page.columns).toEqual([100, 170, 100]);
    expect(page.history.past).toHaveLength(1);
    page.undo();
    expect(page.outline).toBeNull();
    page.redo();
    expect(page.columns).toEqual([100, 170, 100]);
  });

  it('drags from the level of the moment', () => {
    const page = new Page();
    const threshold = new Threshold(region(), page);
    threshold.take(at(100, 100));
    threshold.drag(40);
    threshold.letGo();
    threshold.drag(40);
    expect(threshold.taken?.level).toBeCloseTo(70, 9);
  });

  it('is another unit with another click, and over when somebody else changes the outline', () => {
    const page = new Page();
    const threshold = new Threshold(region(), page);
    threshold.take(at(100, 100));
    threshold.take(at(120, 100));
    expect(page.history.past).toHaveLength(2);
    page.undo();
    expect(threshold.taken).toBeNull();
    expect(threshold.setLevel(90)).toBe(false);
    expect(page.columns).toEqual([100, 150, 100]);
  });

  it('says so where nothing stands out or nothing is left, and keeps what there is', () => {
    const page = new Page();
    const threshold = new Threshold(region(), page);
    threshold.take(at(450, 100));
    expect(page.sentences[0]).toMatch(/stands out/);
    threshold.take(at(100, 100));
    threshold.setLevel(5);
    expect(page.sentences[1]).toMatch(/level of 5/);
    expect(page.columns).toEqual([100, 150, 100]);
    threshold.setLevel(30);
    expect(page.columns).toEqual([100, 130, 100]);
  });
});
