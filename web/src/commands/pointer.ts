import type { FramePoint } from '../geometry/points';
import type { Motion } from '../interaction/adjust';
import type { Hit } from '../interaction/hit';
import { useAtReadingPace } from '../controls/pace';

/** Where the pointer is over the frame. Apart from the store: it changes with every move and nothing is kept of it. */
export interface PointerPlace {
  readonly at: FramePoint;
  readonly hit: Hit;
  /** What a press would do to the model that is adjusted. */
  readonly motion?: Motion | null;
}

class PointerStore {
  #place: PointerPlace | null = null;
  readonly #listeners = new Set<() => void>();

  get place(): PointerPlace | null {
    return this.#place;
  }

  set(place: PointerPlace | null): void {
    if (place === null && this.#place === null) return;
    this.#place = place;
    for (const listener of this.#listeners) listener();
  }

  subscribe(listener: () => void): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }
}

export const pointerStore = new PointerStore();

/** The place, for words and numbers. */
export function usePointer(): PointerPlace | null {
  return useAtReadingPace(subscribe, read);
}

const subscribe = (listener: () => void) => pointerStore.subscribe(listener);
const read = () => pointerStore.place;
