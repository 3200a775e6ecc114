import { withDetours } from '../document/asides';
import type { Store } from '../document/store';
import { type Candidate, cellOf, chosenCandidate, type Doc, verdictAlone } from '../document/types';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { Aborted, type Bridge } from '../workers/bridge';
import type { PoseProtocol } from '../workers/protocol/pose';

/** The good poses of a component, frame by frame. */
type Good = readonly (Candidate | null)[];

/**
 * Sees to it that good poses are doubtful that their film does not go through: each fits by itself. The core says which, of each component's
 * film; it is said anew whenever a pose has changed, and is no unit of undo.
 */
export class DetourWatch {
  readonly #store: Store;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  readonly #asked = new Map<ComponentName, Good>();
  #seen: Doc | null = null;
  #busy = false;

  constructor(store: Store, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#store = store;
    this.#worker = worker;
    store.subscribe(() => void this.#look());
    void this.#look();
  }

  async #look(): Promise<void> {
    const { doc, ui } = this.#store;
    // While poses are being found every one of them would ask anew.
    if (this.#busy || doc === this.#seen || ui.jobs.length > 0) return;
    const films = COMPONENT_NAMES.map((component) => ({ component, film: goodOf(doc, component) }));
    const changed = films.find(({ component, film }) => !alike(film, this.#asked.get(component) ?? []));
    if (!changed) {
      this.#seen = doc;
      return;
    }
    const { component, film } = changed;
    this.#busy = true;
    this.#asked.set(component, film);
    try {
      const told = await this.#worker.call('offTheWay', { poses: film.map((candidate) => candidate?.pose ?? null) }, { lane: 'idle' });
      // What was told of poses that have changed meanwhile is not taken: they are asked about next.
      if (alike(goodOf(this.#store.doc, component), film)) this.#store.amend((doc) => withDetours(doc, component, told));
    } catch (error) {
      if (error instanceof Aborted) this.#asked.delete(component);
    } finally {
      this.#busy = false;
      queueMicrotask(() => void this.#look());
    }
  }
}

function goodOf(doc: Doc, component: ComponentName): Good {
  return doc.frames.map(({ id }) => {
    const cell = cellOf(doc, id, component);
    return verdictAlone(cell.result)?.word === 'good' ? chosenCandidate(cell) : null;
  });
}

function alike(some: Good, others: Good): boolean {
  return some.length === others.length && some.every((candidate, at) => candidate === others[at]);
}
