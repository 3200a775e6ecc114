import { useEffect, useState } from 'preact/hooks';
import type { FramePoint } from '../geometry/points';
import type { Motion } from '../interaction/adjust';
import type { Hit } from '../interaction/hit';

/** Where the pointer is over the film. Apart from the store: it changes with every move and nothing is kept of it. */
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

/** The place, at most once a screen frame. */
export function usePointer(): PointerPlace | null {
  const [place, setPlace] = useState(pointerStore.place);
  useEffect(() => {
    let scheduled = 0;
    const unsubscribe = pointerStore.subscribe(() => {
      scheduled ||= requestAnimationFrame(() => {
        scheduled = 0;
        setPlace(pointerStore.place);
      });
    });
    return () => {
      unsubscribe();
      cancelAnimationFrame(scheduled);
    };
  }, []);
  return place;
}
