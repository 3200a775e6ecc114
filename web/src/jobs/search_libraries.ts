import { cameraOf, libraryKey } from '../results/keys';
import { type ComponentName, titleOf } from '../terms/component';
import { texts } from '../texts/texts';
import type { Bridge } from '../workers/bridge';
import type { FirstPosesProtocol } from '../workers/protocol/first_poses';
import type { PoseProtocol } from '../workers/protocol/pose';
import { libraryWorker } from '../workers/start';
import { libraryPlan } from './library_plan';
import { LibraryPool, workersFor } from './library_pool';
import { asJob, type Services } from './services';

/** A distance in mm; null: of the library that outlines are compared with. */
export type Distance = number | null;

interface Built {
  /** What it was built from. */
  readonly key: string;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

/** How a search is called off, and by whom. */
export interface CalledOff {
  readonly signal: AbortSignal;
  readonly cancel: () => void;
}

type Core = Pick<Bridge<FirstPosesProtocol>, 'call'>;

/**
 * The libraries that a component is looked for with where nobody points at it: the one that outlines are compared with, or, where nothing
 * tells how far away it is, others as well, which are built when they are first wanted.
 */
export class SearchLibraries {
  readonly #services: Services;
  readonly #poser: Pick<Bridge<PoseProtocol>, 'call'>;
  readonly #pool: Pick<LibraryPool, 'build'>;
  readonly #built = new Map<string, Built>();

  constructor(services: Services, poser: Pick<Bridge<PoseProtocol>, 'call'>, pool: Pick<LibraryPool, 'build'> = new LibraryPool(workersFor(navigator.hardwareConcurrency), libraryWorker)) {
    this.#services = services;
    this.#poser = poser;
    this.#pool = pool;
  }

  /** In the order in which they are tried; those that serve a component which is about so far away, mm, where that is known. */
  async distances(component: ComponentName, core: Core, depth: number | null): Promise<readonly Distance[]> {
    const { doc } = this.#services.store;
    const { libraryFile, librarySpec } = doc.components[component];
    const camera = cameraOf(doc, doc.frames[0] ?? null);
    const told = librarySpec.distance;
    if (libraryFile || !camera || told !== null) return [null];
    const all = await core.call('distances', { camera, told, depth: null });
    if (all.length < 2) return [null];
    return depth === null ? all : core.call('distances', { camera, told, depth });
  }

  /** A library's bytes, which are the caller's. */
  async bytes(component: ComponentName, distance: Distance, calledOff: CalledOff): Promise<Uint8Array<ArrayBuffer>> {
    if (distance === null) return this.#poser.call('library', { component });
    const at = `${component} ${distance}`;
    const key = libraryKey(this.#services.store.doc, component) ?? '';
    let built = this.#built.get(at);
    if (built?.key !== key) this.#built.set(at, (built = { key, bytes: await this.#build(component, distance, calledOff) }));
    return built.bytes.slice();
  }

  #build(component: ComponentName, distance: number, { signal, cancel }: CalledOff): Promise<Uint8Array<ArrayBuffer>> {
    const plan = libraryPlan(this.#services, component);
    const job = { title: texts.said.library.job(titleOf(component)), unit: texts.said.library.views, total: 0, cancel };
    return asJob(this.#services.store, job, (onProgress) => this.#pool.build({ ...plan, spec: { ...plan.spec, distance } }, { signal, onProgress }));
  }
}
