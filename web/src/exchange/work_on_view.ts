import type { Store } from '../document/store';
import { type Doc, EMPTY_DOC } from '../document/types';

/** The work that files are opened for. What is read of them comes late, and other work may be on view by then. */
export class WorkOnView {
  readonly #store: Store;
  #seen: Doc;

  constructor(store: Store) {
    this.#store = store;
    this.#seen = this.#noted();
  }

  /** Once what is opened has brought a work of its own to view, or frames into it. */
  follow(): void {
    this.#seen = this.#noted();
  }

  isHere(): boolean {
    const { doc } = this.#store;
    // A work gets its identity with the first thing that is in it; frames come from here alone.
    return this.#seen.work === '' ? doc !== EMPTY_DOC && doc.frames === this.#seen.frames : doc.work === this.#seen.work;
  }

  /** Where nothing came, nothing was begun. */
  letGo(): void {
    this.#store.amend((doc) => (doc === this.#seen && isEmpty(doc) ? EMPTY_DOC : doc));
  }

  /** The empty page is none that somebody begins anew meanwhile. */
  #noted(): Doc {
    this.#store.amend((doc) => (doc === EMPTY_DOC ? { ...doc } : doc));
    return this.#store.doc;
  }
}

function isEmpty(doc: Doc): boolean {
  return (Object.keys(EMPTY_DOC) as (keyof Doc)[]).every((key) => doc[key] === EMPTY_DOC[key]);
}
