import type { Store } from '../document/store';
import { masksOff } from '../results/masks_off';
import type { ComponentName } from '../terms/component';
import { later } from '../texts/later';
import { texts } from '../texts/texts';

/** Says where many masks of an import are not borne out by their frames, once all of them were asked. */
export class MasksTold {
  readonly #store: Store;
  readonly #corrected = new Set<ComponentName>();
  /** Of how many masks: what was told is not told again while one of their poses changes. */
  readonly #told = new Map<ComponentName, number>();

  constructor(store: Store) {
    this.#store = store;
  }

  corrected(component: ComponentName): void {
    this.#corrected.add(component);
  }

  /** Nothing is left to be corrected. */
  rested(): void {
    const corrected = [...this.#corrected];
    // What is said is a change, after which the film may rest again.
    this.#corrected.clear();
    const sentences = corrected.flatMap((component) => {
      const told = masksOff(this.#store.doc, component);
      const isTold = (told?.of ?? 0) === (this.#told.get(component) ?? 0);
      this.#told.set(component, told?.of ?? 0);
      return told && !isTold ? [later.check.masksOff(told.off, told.of, texts.component[component])] : [];
    });
    if (sentences.length > 0) this.#store.say('info', sentences.join(' '));
  }
}
