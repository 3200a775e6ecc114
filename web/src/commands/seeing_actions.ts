import type { Store } from '../document/store';
import type { SeeingAction } from './seeing_bindings';
import type { HandActions } from './hand_actions';

/** What keys and buttons change of how things are shown. */
export class SeeingActions {
  readonly #store: Store;
  readonly #hand: HandActions;

  constructor(store: Store, hand: HandActions) {
    this.#store = store;
    this.#hand = hand;
  }

  run(action: SeeingAction): boolean {
    const { seeing, popover } = this.#store.ui;
    switch (action.name) {
      case 'preprocessing':
        this.#store.see({ preprocessing: action.preprocessing });
        return true;
      case 'overlay':
        this.#store.see({ overlay: action.style });
        return true;
      case 'magnifier':
        this.#store.see({ magnifier: !seeing.magnifier });
        return true;
      case 'ghosts':
        this.#store.see({ ghosts: !seeing.ghosts });
        return true;
      case 'scale-bar':
        this.#store.see({ scaleBar: !seeing.scaleBar });
        return true;
      case 'compare':
        this.#hand.toggleCompare();
        return true;
      case 'view-sheet':
        this.#store.show({ popover: popover === 'view' ? null : 'view' });
        return true;
    }
  }
}
