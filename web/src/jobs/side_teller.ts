import { knownAxes } from '../document/axes';
import type { Doc } from '../document/types';
import type { Bridge } from '../workers/bridge';
import type { PoseProtocol } from '../workers/protocol/pose';
import type { Services } from './services';

type KnownSide = 'left' | 'right';

/** Finds out which knee the femur is made for while nobody has said which it is: what a person is shown who is asked. */
export class SideTeller {
  readonly #services: Services;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  /** By model and axes; null while it is being asked, and where the flange does not tell. */
  readonly #told = new Map<string, KnownSide | null>();

  constructor(services: Services, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#services = services;
    this.#worker = worker;
    services.store.subscribe(() => void this.#look());
  }

  /** Null where the side is known, and where the flange does not tell. */
  get told(): KnownSide | null {
    const asked = askedOf(this.#services.store.doc);
    return (asked && this.#told.get(asked.key)) ?? null;
  }

  async #look(): Promise<void> {
    const { store, studio } = this.#services;
    const asked = askedOf(store.doc);
    const mesh = asked && !this.#told.has(asked.key) ? studio.meshOf(asked.sha256) : null;
    if (!asked || !mesh) return;
    this.#told.set(asked.key, null);
    try {
      this.#told.set(asked.key, await this.#worker.call('flangeSide', { mesh, axes: asked.axes }, { lane: 'idle' }));
      store.show({});
    } catch {
      // What cannot be looked at tells nothing: the person is asked all the same.
    }
  }
}

function askedOf({ side, components: { femur } }: Doc) {
  const [axes, sha256] = [knownAxes(femur), femur.model?.sha256];
  return side === 'unknown' && axes && sha256 ? { axes, sha256, key: `${sha256} ${JSON.stringify(axes)}` } : null;
}
