import type { Place } from '../document/command';
import { filmNumbers } from '../document/film';
import { currentPlace } from '../document/store';
import { type Candidate, cellOf, chosenCandidate } from '../document/types';
import { COMPONENT_NAMES } from '../terms/component';
import { poseKey } from '../results/keys';
import { Aborted, type Bridge } from '../workers/bridge';
import type { EdgeFacts } from '../workers/protocol/by_hand';
import { poseArray } from '../workers/protocol/pose_array';
import type { PoseProtocol } from '../workers/protocol/pose';
import { frameOf, onFrameInput } from './from_here';
import { Pause } from './pause';
import type { Services } from './services';

interface Asked {
  readonly place: Place;
  readonly candidate: Candidate;
  /** All that the answer depends on but the frame. */
  readonly key: string;
}

/** How long a frame has to be on view before its edges are read, ms: nobody wants them while the film plays. */
export const EDGES_REST = 200;

/** Reads where the frame's edges lie beside the models on view, one after the other, the selected one first. */
export class EdgeWatch {
  readonly #services: Services;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  /** Without facts where the frame could not be asked. */
  readonly #read = new WeakMap<Candidate, { readonly key: string; readonly facts: EdgeFacts | null }>();
  readonly #pause = new Pause();
  #busy = false;

  constructor(services: Services, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#services = services;
    this.#worker = worker;
    services.store.subscribe(() => this.#consider());
  }

  /** Null while they are not read, or cannot be. */
  of(candidate: Candidate | null | undefined): EdgeFacts | null {
    return (candidate && this.#read.get(candidate)?.facts) ?? null;
  }

  #consider(): void {
    this.#pause.end();
    if (this.#busy || !this.#find()) return;
    this.#pause.before(EDGES_REST, () => void this.#next());
  }

  #find(): Asked | null {
    const { store } = this.#services;
    const shown = currentPlace(store.state);
    if (!shown) return null;
    const components = [shown.component, ...COMPONENT_NAMES.filter((name) => name !== shown.component)];
    for (const component of components) {
      const asked = this.#asked({ ...shown, component });
      if (asked && this.#read.get(asked.candidate)?.key !== asked.key) return asked;
    }
    return null;
  }

  #asked(place: Place): Asked | null {
    const { doc, ui } = this.#services.store;
    const { frameId, component } = place;
    const candidate = chosenCandidate(cellOf(doc, frameId, component));
    const frame = frameOf(doc, place);
    const by = frame && poseKey(doc, component, frame);
    if (!candidate || !by || ui.libraries[component].state !== 'ready') return null;
    const others = COMPONENT_NAMES.filter((name) => name !== component).map((name) => chosenCandidate(cellOf(doc, frameId, name)));
    const beside = others.map((other) => (other ? poseArray(other.pose) : []));
    return { place, candidate, key: JSON.stringify([by, filmNumbers(doc, component), beside]) };
  }

  async #next(): Promise<void> {
    const asked = this.#find();
    if (!asked) return;
    this.#busy = true;
    const { place, candidate, key } = asked;
    try {
      const input = await onFrameInput(this.#services, place);
      const facts = await this.#worker.call('readOnFrame', { ...input, pose: candidate.pose }, { transfer: [input.frame.pixels.buffer] });
      this.#read.set(candidate, { key, facts });
    } catch (error) {
      // Without pixels nobody can say; the pose is there all the same.
      if (!(error instanceof Aborted)) this.#read.set(candidate, { key, facts: null });
    } finally {
      this.#busy = false;
      // No part of the state: the views are notified all the same, and that asks for the next.
      this.#services.store.show({});
    }
  }
}
