import type { State, Store } from '../document/store';
import { cellOf, chosenCandidate, type FrameEntry } from '../document/types';
import { COMPONENT_NAMES } from '../terms/component';
import { cameraOf } from '../results/keys';
import { sentenceOf } from '../jobs/services';
import type { Studio } from '../films/studio';
import type { Size, Viewport } from '../geometry/viewport';
import { texts } from '../texts/texts';
import { meshOf, pinholeOf } from '../commands/model_in_hand';
import { loadOverlay, NoWebgl } from './three/load';
import type { PlacedModel } from './three/models';
import type { ShadedOverlay } from './three/overlay';

/** Shaded models for the stage, once the 3-D library is there; until then, and without it, there are outlines. */
export class Shading {
  readonly #store: Store;
  readonly #studio: Studio;
  #overlay: ShadedOverlay | null = null;
  #state: 'asleep' | 'loading' | 'awake' | 'failed' = 'asleep';
  #drawn: { key: readonly unknown[]; picture: HTMLCanvasElement } | null = null;

  constructor(store: Store, studio: Studio) {
    this.#store = store;
    this.#studio = studio;
  }

  /** Null while there is nothing to show, or nothing to show it with. */
  picture(state: State, frame: FrameEntry, view: Viewport, size: Size): HTMLCanvasElement | null {
    if (state.ui.seeing.overlay !== 'shaded') return null;
    if (this.#state === 'asleep') void this.#wake();
    const pinhole = pinholeOf(this.#studio, cameraOf(state.history.present, frame));
    const models = placedModels(state, this.#studio, frame);
    if (!this.#overlay || !pinhole || models.length === 0) return null;
    const ratio = window.devicePixelRatio || 1;
    const poses = models.flatMap(({ pose, mesh }) => [pose, mesh]);
    const key = [pinhole, view.scale, view.left, view.top, size.width, size.height, ratio, ...poses];
    const same = this.#drawn?.key.length === key.length && key.every((part, at) => part === this.#drawn?.key[at]);
    if (!same || !this.#drawn) this.#drawn = { key, picture: this.#kept(this.#overlay.draw(models, pinhole, view, size, ratio)) };
    return this.#drawn.picture;
  }

  /** A copy: what WebGL drew is gone with the next task. */
  #kept(drawn: HTMLCanvasElement): HTMLCanvasElement {
    const copy = this.#drawn?.picture ?? document.createElement('canvas');
    copy.width = drawn.width;
    copy.height = drawn.height;
    copy.getContext('2d')?.drawImage(drawn, 0, 0);
    return copy;
  }

  async #wake(): Promise<void> {
    this.#state = 'loading';
    try {
      const Overlay = await loadOverlay();
      this.#overlay = new Overlay();
      this.#state = 'awake';
      this.#store.show({});
    } catch (error) {
      this.#state = 'failed';
      const why = error instanceof NoWebgl ? texts.seeing.space.noWebgl : sentenceOf(error);
      this.#store.say('error', texts.seeing.space.failed(why));
    }
  }
}

/** The models of a frame that have a pose. */
export function placedModels(state: State, studio: Studio, frame: FrameEntry): PlacedModel[] {
  const { present: doc } = state.history;
  return COMPONENT_NAMES.flatMap((component) => {
    const mesh = meshOf(doc, component, studio);
    const pose = chosenCandidate(cellOf(doc, frame.id, component))?.pose;
    return mesh && pose ? [{ component, mesh, pose }] : [];
  });
}
