import type { Command, Place } from '../document/command';
import { byHand, byTool } from '../document/laid_by';
import { addPoints, setOutline } from '../document/outlines';
import type { Outline } from '../document/types';
import { type FramePoint, pointsFrom } from '../geometry/points';
import { flat, type CoolingPixels, type WirePixels } from './pixels';
import { NO_PREVIEW, type Preview } from './preview';
import { texts } from '../texts/texts';

/** What the live-wire asks of the page; tests supply their own. */
export interface WireHost {
  readonly place: Place | null;
  readonly outline: Outline | null;
  /** How far from the pointer an edge is looked for, frame pixels. */
  readonly radius: number;
  readonly cooling: boolean;
  now(): number;
  perform(command: Command): void;
  /** The path at sub-pixel accuracy and with few points; its ends stay. */
  refined(path: readonly FramePoint[], side: number): readonly FramePoint[];
}

/** What is known of a draft that the document does not keep. */
interface Seeds {
  /** How many points it had when each stretch began. */
  readonly counts: readonly number[];
  /** Which hand the implant is on: +1 right, -1 left, 0 not known yet. */
  readonly side: number;
}

const NO_SEEDS: Seeds = { counts: [], side: 0 };

/** Rows and pixels that take well under a millisecond or two. */
const ROWS = 32;
const PIXELS = 8000;
const ALL = 2 ** 31 - 1;
/** Two clicks on one spot are one, px. */
const SAME_SPOT = 2;
/** Cooled stretches are no shorter than this, and the hand keeps this much of the path, path points. */
const SHORTEST = 24;
const KEPT = 24;
/** A pause is no sign that a path is good: only so much of it counts as the path's rest, ms. */
const LONGEST_STEP = 60;
/** From here on `darkSide` is believed. */
const CLEAR = 0.2;

/**
 * The live-wire of one frame. Its seed is always the last point of the draft in the document: whatever undo, another tool
 * or another frame does to the draft, the wire goes on from there.
 */
export class Wire {
  readonly #pixels: WirePixels;
  readonly #cooling: CoolingPixels;
  readonly #host: WireHost;
  readonly #seeds = new WeakMap<Outline, Seeds>();
  #prepared = false;
  #expanded = false;
  #seed: FramePoint | null = null;
  #aim: { readonly at: FramePoint; readonly straight: boolean } | null = null;
  #aimed = false;
  #path: readonly FramePoint[] = [];
  #clock = { at: 0, moving: 0 };

  constructor(pixels: WirePixels, cooling: CoolingPixels, host: WireHost) {
    this.#pixels = pixels;
    this.#cooling = cooling;
    this.#host = host;
  }

  free(): void {
    this.#pixels.free();
  }

  get preview(): Preview {
    const draft = this.#draft;
    if (!this.#aim) return NO_PREVIEW;
    if (!draft) return { kind: 'spot', at: this.#begin(this.#aim) };
    const last = draft.points.at(-1)!;
    if (this.#aim.straight) return { kind: 'path', points: [last, this.#aim.at] };
    return this.#path.length > 1 ? { kind: 'path', points: this.#path } : NO_PREVIEW;
  }

  aim(at: FramePoint, straight: boolean): void {
    this.#aim = { at, straight };
    this.#aimed = false;
    const now = this.#host.now();
    this.#clock = { at: now, moving: this.#clock.moving + Math.min(LONGEST_STEP, Math.max(0, now - this.#clock.at)) };
  }

  leave(): void {
    this.#aim = null;
    this.#path = [];
  }

  /** A few milliseconds of work, once a screen frame; true while there is more to do. */
  tick(milliseconds: number): boolean {
    const end = this.#host.now() + milliseconds;
    while (!this.#prepared && this.#host.now() < end) this.#prepared = this.#pixels.prepare(ROWS);
    if (!this.#prepared) return true;
    this.#follow(PIXELS);
    while (this.#seed && !this.#expanded && this.#host.now() < end) {
      this.#expanded = this.#pixels.expand(PIXELS);
      this.#follow(PIXELS);
    }
    return this.#seed !== null && !this.#expanded;
  }

  /** Fixes the path as it is at a place. The first one begins the draft. */
  fix(at: FramePoint, straight: boolean): void {
    this.#prepareAll();
    const { place } = this.#host;
    const draft = this.#draft;
    if (!place || this.#host.outline?.closed) return;
    this.#aim = { at, straight };
    if (!draft) return this.#perform(addPoints(place, texts.steps.beginOutline, [this.#begin(this.#aim)], false, byTool), { counts: [0], side: 0 });
    const last = draft.points.at(-1)!;
    if (away(last, at) <= SAME_SPOT) return;
    if (straight) return this.#append(draft, [at], [], texts.steps.straightStretch);
    this.#aimed = false;
    this.#follow(ALL, false);
    // Beyond the frame's border there is no edge to follow.
    if (!this.#aimed) return this.#append(draft, [at], [], texts.steps.straightStretch);
    this.#fixPath(draft, this.#path, texts.steps.followEdge);
  }

  /** Follows the edge back to the first point and closes the draft there. False where there is no draft to close. */
  close(straight = false): boolean {
    const draft = this.#draft;
    const { place } = this.#host;
    const first = draft?.points[0];
    if (!draft || !place || !first || draft.points.length < 2) return false;
    this.#prepareAll();
    this.#settle(draft);
    const points = straight ? [] : this.#refined(draft, this.#pathTo(first)).slice(1, -1);
    this.#perform(addPoints(place, texts.steps.closeOutline, points, true, straight ? byHand : byTool), NO_SEEDS);
    this.leave();
    return true;
  }

  /** Takes the last stretch back; undo can bring it again. */
  takeBack(): boolean {
    const draft = this.#draft;
    const { place } = this.#host;
    if (!draft || !place) return false;
    const seeds = this.#seeds.get(draft) ?? NO_SEEDS;
    const count = seeds.counts.at(-1) ?? draft.points.length - 1;
    const unknownSides = draft.unknownSides.filter((side) => side < count - 1);
    const shorter: Outline | null = count > 0 ? { ...draft, points: draft.points.slice(0, count), unknownSides } : null;
    this.#perform(setOutline(place, texts.steps.takeStretchBack, shorter), { counts: seeds.counts.slice(0, -1), side: count > 1 ? seeds.side : 0 });
    return true;
  }

  get #draft(): Outline | null {
    const { outline } = this.#host;
    return outline && !outline.closed && outline.points.length > 0 ? outline : null;
  }

  #begin({ at, straight }: { at: FramePoint; straight: boolean }): FramePoint {
    if (straight || !this.#prepared) return at;
    return pointsFrom(this.#pixels.snapPoint(at.column, at.row, this.#host.radius))[0] ?? at;
  }

  #prepareAll(): void {
    while (!this.#prepared) this.#prepared = this.#pixels.prepare(ROWS);
  }

  /** Sows anew where the draft has got another last point. */
  #settle(draft: Outline | null): void {
    const last = draft?.points.at(-1) ?? null;
    if (last && this.#seed && last.column === this.#seed.column && last.row === this.#seed.row) return;
    this.#seed = last;
    this.#expanded = last === null;
    this.#path = [];
    this.#aimed = false;
    if (!draft || !last) return;
    this.#pixels.seed(last.column, last.row, (this.#seeds.get(draft) ?? NO_SEEDS).side);
    this.#cooling.restart();
  }

  /** Brings the path to where the pointer is, if the tree reaches that far after so many more pixels. */
  #follow(pixels: number, cools = true): void {
    const draft = this.#draft;
    this.#settle(draft);
    const aim = this.#aim;
    if (!draft || !aim || aim.straight || this.#aimed) return;
    const path = pointsFrom(this.#pixels.follow(aim.at.column, aim.at.row, this.#host.radius, pixels));
    if (path.length === 0) return;
    this.#aimed = true;
    this.#path = [draft.points.at(-1)!, ...path.slice(1)];
    if (cools) this.#cool(draft);
  }

  /** What has stayed the same for long while the hand moved is fixed, as if it had been clicked. */
  #cool(draft: Outline): void {
    const { length } = this.#path;
    const settled = this.#cooling.observe(this.#clock.moving, this.#pixels.common, length);
    const count = Math.min(settled, length - KEPT);
    if (!this.#host.cooling || count < SHORTEST) return;
    this.#fixPath(draft, this.#path.slice(0, count), texts.steps.followEdge);
  }

  #pathTo(at: FramePoint): readonly FramePoint[] {
    const path = pointsFrom(this.#pixels.follow(at.column, at.row, 0, ALL));
    return path.length > 1 ? [...path.slice(0, -1), at] : [at, at];
  }

  #fixPath(draft: Outline, path: readonly FramePoint[], label: string): void {
    if (path.length < 2) return;
    this.#append(draft, this.#refined(draft, path).slice(1), path, label);
  }

  #refined(draft: Outline, path: readonly FramePoint[]): readonly FramePoint[] {
    const whole = [draft.points.at(-1)!, ...path.slice(1)];
    return whole.length > 2 ? this.#host.refined(whole, this.#sideOf(draft, path)) : whole;
  }

  #append(draft: Outline, points: readonly FramePoint[], path: readonly FramePoint[], label: string): void {
    const { place } = this.#host;
    if (!place) return;
    const seeds = this.#seeds.get(draft) ?? NO_SEEDS;
    const counts = [...seeds.counts, draft.points.length];
    this.#perform(addPoints(place, label, points, false, path.length > 0 ? byTool : byHand), { counts, side: this.#sideOf(draft, path) });
  }

  #sideOf(draft: Outline, path: readonly FramePoint[]): number {
    const before = (this.#seeds.get(draft) ?? NO_SEEDS).side;
    if (path.length < SHORTEST) return before;
    const dark = this.#pixels.darkSide(flat(path));
    return Math.abs(dark) >= CLEAR ? Math.sign(dark) : before;
  }

  #perform(command: Command, seeds: Seeds): void {
    this.#host.perform(command);
    const { outline } = this.#host;
    if (outline && !outline.closed) this.#seeds.set(outline, seeds);
    this.#settle(this.#draft);
  }
}

function away(a: FramePoint, b: FramePoint): number {
  return Math.hypot(a.column - b.column, a.row - b.row);
}
