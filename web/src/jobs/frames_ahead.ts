import type { FrameEntry } from '../document/types';
import { sentenceOf, type Services } from './services';

/** Frames after the one on view, in the direction in which somebody goes, and the one that was just left. */
const AHEAD = [0, 1, 2, 3, -1];

/** Sees to it that the frame on view is in memory, and those that come next. */
export class FramesAhead {
  readonly #services: Pick<Services, 'store' | 'studio'>;
  #frames: readonly FrameEntry[] = [];
  #index = 0;
  #framesKnown = 0;

  constructor(services: Pick<Services, 'store' | 'studio'>) {
    this.#services = services;
    services.store.subscribe(() => this.#look());
    // No part of the state: the views are notified.
    services.studio.onArrival = () => services.store.show({});
    services.studio.onTrouble = (error) => services.store.say('error', sentenceOf(error));
  }

  #look(): void {
    const { store, studio } = this.#services;
    const { frames } = store.doc;
    const { frameIndex } = store.ui;
    if (frames === this.#frames && frameIndex === this.#index && studio.known === this.#framesKnown) return;
    const direction = frameIndex < this.#index ? -1 : 1;
    this.#frames = frames;
    this.#index = frameIndex;
    this.#framesKnown = studio.known;
    studio.expect(AHEAD.flatMap((step) => frames[frameIndex + direction * step]?.id ?? []));
  }
}
