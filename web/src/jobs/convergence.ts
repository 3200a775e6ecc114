import { currentCell, currentFrame, type Store } from '../document/store';
import { chosenCandidate, type Candidate } from '../document/types';
import { Aborted, type Bridge } from '../workers/bridge';
import { cameraOf } from '../results/keys';
import { flatten, type Poser } from './poser';
import type { ConvergenceStep, PoseProtocol } from '../workers/protocol/pose';
import { sentenceOf } from './services';

export type Trace = { readonly steps: readonly ConvergenceStep[] } | { readonly refusal: string };

/** Asks how refinement came to the pose on view, while somebody looks at that: it costs as much again. */
export class Convergence {
  readonly #store: Store;
  readonly #poser: Poser;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  readonly #traces = new WeakMap<Candidate, Trace>();
  #busy = false;

  constructor(store: Store, poser: Poser, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#store = store;
    this.#poser = poser;
    this.#worker = worker;
    store.subscribe(() => void this.#next());
  }

  /** Null while it is on its way. */
  of(candidate: Candidate | null): Trace | null {
    return (candidate && this.#traces.get(candidate)) ?? null;
  }

  async #next(): Promise<void> {
    const { state, doc } = this.#store;
    if (this.#busy || state.ui.popover !== 'convergence') return;
    const cell = currentCell(state);
    const { outline } = cell;
    const candidate = chosenCandidate(cell);
    const start = candidate && this.#poser.detail(outline, candidate)?.start;
    const camera = cameraOf(doc, currentFrame(state));
    if (!outline || !candidate || !start || !camera || this.#traces.has(candidate)) return;
    this.#busy = true;
    try {
      const { component } = state.ui;
      const steps = await this.#worker.call('converge', { component, ...flatten(outline), camera, start });
      this.#traces.set(candidate, { steps });
    } catch (error) {
      if (!(error instanceof Aborted)) this.#traces.set(candidate, { refusal: sentenceOf(error) });
    } finally {
      this.#busy = false;
      // The traces are no part of the state: the views are notified all the same.
      this.#store.show({});
    }
  }
}
