import { OWN_AXES, withAxes } from '../document/axes';
import type { Axes } from '../document/types';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { Aborted, type Bridge } from '../workers/bridge';
import type { PoseProtocol } from '../workers/protocol/pose';
import type { Services } from './services';

const NOTHING_TOLD: Axes = { directions: OWN_AXES, from: 'shape', told: 'nothing' };

/** Sees to it that the axes of every model are known as far as its shape tells them. What somebody said stays. */
export class Anatomist {
  readonly #services: Services;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  /** By component and model; null while it is being asked. */
  readonly #found = new Map<string, Axes | null>();

  constructor(services: Services, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#services = services;
    this.#worker = worker;
    services.store.subscribe(() => this.#look());
  }

  #look(): void {
    const { store, studio } = this.#services;
    for (const component of COMPONENT_NAMES) {
      const { model, axes } = store.doc.components[component];
      const mesh = model && !axes ? studio.meshOf(model.sha256) : null;
      if (!model || !mesh) continue;
      const key = `${component} ${model.sha256}`;
      const found = this.#found.get(key);
      if (found) this.#take(component, model.sha256, found);
      else if (found === undefined) void this.#ask(component, model.sha256, key);
    }
  }

  async #ask(component: ComponentName, sha256: string, key: string): Promise<void> {
    const { store, studio } = this.#services;
    const mesh = studio.meshOf(sha256);
    if (!mesh) return;
    this.#found.set(key, null);
    try {
      const told = await this.#worker.call('axes', { component, mesh }, { lane: 'idle' });
      this.#found.set(key, { ...told, from: 'shape' });
    } catch (error) {
      // A shape that cannot be looked at tells nothing; what was called off is asked again.
      if (error instanceof Aborted) this.#found.delete(key);
      else this.#found.set(key, NOTHING_TOLD);
    }
    store.show({});
  }

  /** No unit of undo: nobody did anything. */
  #take(component: ComponentName, sha256: string, axes: Axes): void {
    this.#services.store.amend((doc) => {
      const { model, axes: known } = doc.components[component];
      return known || model?.sha256 !== sha256 ? doc : withAxes(doc, component, axes);
    });
  }
}
