import type { Command, Place } from '../document/command';
import { currentCell, currentPlace, type Store } from '../document/store';
import type { Outline } from '../document/types';
import type { FramePoint } from '../geometry/points';
import type { FrameImage } from '../pkg/page/fluoropose_page.js';
import { snappedPath } from './pixels';
import type { ThresholdHost } from './threshold';
import type { WireHost } from './wire';

/** An edge is looked for this near the pointer, CSS px, but never farther than so many frame px. */
const SNAP_RADIUS = 10;
const MOST_RADIUS = 12;
/** A path is brought to the edge that it follows, px. */
const PATH_REACH = 2;
/** Fewer points to hold afterwards: noise moves an edge by more than this from pixel to pixel. */
const PATH_TOLERANCE = 0.5;

/** The page as the tools see it, with one frame. */
export class Host implements WireHost, ThresholdHost {
  readonly #store: Store;
  readonly #image: FrameImage;
  readonly #bright: boolean;
  readonly #scale: () => number;

  /** `scale`: CSS pixels a frame pixel, now. */
  constructor(store: Store, image: FrameImage, bright: boolean, scale: () => number) {
    this.#store = store;
    this.#image = image;
    this.#bright = bright;
    this.#scale = scale;
  }

  get place(): Place | null {
    return currentPlace(this.#store.state);
  }

  get outline(): Outline | null {
    return currentCell(this.#store.state).outline;
  }

  get radius(): number {
    return Math.min(MOST_RADIUS, Math.max(1, SNAP_RADIUS / this.#scale()));
  }

  get cooling(): boolean {
    return this.#store.ui.tracing.cooling;
  }

  get level(): number | null {
    return this.#store.ui.tracing.level;
  }

  get bridge(): number {
    return this.#store.ui.tracing.bridge;
  }

  now(): number {
    return performance.now();
  }

  perform(command: Command): void {
    this.#store.perform(command);
  }

  say(sentence: string): void {
    this.#store.say('info', sentence);
  }

  refined(path: readonly FramePoint[], side: number): readonly FramePoint[] {
    return snappedPath(this.#image, path, side, !this.#bright, PATH_REACH, PATH_TOLERANCE).points;
  }
}
