import { canvasPoint, distance, type CanvasPoint } from '../geometry/points';
import { pan, zoomAt, type Viewport } from '../geometry/viewport';

/** What becomes of a touch: the tool has it, the frame moves under it, or nothing (a palm, a third finger). */
export type Use = 'tool' | 'view' | 'nothing';

/**
 * Fingers on the frame. One draws, two move and zoom the frame; once a pen was seen a single finger moves the frame too,
 * because a hand rests on the screen while its pen draws.
 */
export class Touches {
  readonly #fingers = new Map<number, CanvasPoint>();
  #penSeen = false;
  /** The frame moves until all fingers are up: the last one of a pinch must not draw. */
  #moving = false;

  /** A pen touches the frame. */
  pen(): void {
    this.#penSeen = true;
  }

  get moving(): boolean {
    return this.#moving;
  }

  /** What the finger is for; `view` may take it from a tool that had the first finger. */
  down(id: number, at: CanvasPoint): Use {
    this.#fingers.set(id, at);
    if (this.#fingers.size > 2) return 'nothing';
    this.#moving ||= this.#penSeen || this.#fingers.size === 2;
    return this.#moving ? 'view' : 'tool';
  }

  /** The frame after a finger has moved; null where the tool has the finger. */
  move(id: number, at: CanvasPoint, viewport: Viewport): Viewport | null {
    const before = this.#fingers.get(id);
    if (!before) return null;
    const others = [...this.#fingers].filter(([other]) => other !== id).map(([, place]) => place);
    this.#fingers.set(id, at);
    if (!this.#moving) return null;
    const other = others[0];
    if (others.length > 1) return viewport;
    if (!other) return pan(viewport, at.x - before.x, at.y - before.y);
    return pinched(viewport, [before, at], other);
  }

  /** True when the finger belonged to the frame. */
  up(id: number): boolean {
    const known = this.#fingers.delete(id);
    const moving = known && this.#moving;
    if (this.#fingers.size === 0) this.#moving = false;
    return moving;
  }
}

/** What lay between the fingers stays between them. */
function pinched(viewport: Viewport, [before, now]: readonly [CanvasPoint, CanvasPoint], other: CanvasPoint): Viewport {
  const middle = (a: CanvasPoint) => canvasPoint((a.x + other.x) / 2, (a.y + other.y) / 2);
  const [from, to] = [middle(before), middle(now)];
  const factor = distance(now, other) / Math.max(1, distance(before, other));
  return zoomAt(pan(viewport, to.x - from.x, to.y - from.y), to, factor);
}
