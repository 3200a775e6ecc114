import type { Doc } from '../document/types';
import { COMPONENT_NAMES, type ComponentName, titleOf } from '../terms/component';
import { Aborted, type Bridge } from '../workers/bridge';
import { libraryKey } from '../results/keys';
import { libraryPlan } from './library_plan';
import { LibraryPool, workersFor } from './library_pool';
import type { PoseProtocol } from '../workers/protocol/pose';
import type { LibraryFacts } from '../workers/protocol/library';
import { asJob, sentenceOf, type Services } from './services';
import { libraryWorker } from '../workers/start';
import { texts } from '../texts/texts';

/**
 * Sees to it that each component has the library that the document asks for: as soon as model, calibration and frame
 * size are there it is built, when one of them changes it is built anew. What was called off stays off until asked for.
 */
export class Librarian {
  readonly #services: Services;
  readonly #poser: Bridge<PoseProtocol>;
  readonly #running = new Map<ComponentName, AbortController>();
  readonly #pool = new LibraryPool(workersFor(navigator.hardwareConcurrency), libraryWorker);

  constructor(services: Services, poser: Bridge<PoseProtocol>) {
    this.#services = services;
    this.#poser = poser;
    services.store.subscribe(() => this.#reconcile());
    // A new pose worker holds no libraries yet.
    poser.onCrash = () => COMPONENT_NAMES.forEach((component) => this.retry(component));
  }

  /** Builds again what was called off or failed. */
  retry(component: ComponentName): void {
    this.#services.store.setLibrary(component, { state: 'none' });
  }

  #reconcile(): void {
    const { store } = this.#services;
    for (const component of COMPONENT_NAMES) {
      const wanted = libraryKey(store.doc, component);
      const library = store.ui.libraries[component];
      const present = library.state === 'none' ? null : library.key;
      if (wanted === present) continue;
      this.#running.get(component)?.abort();
      if (wanted !== null && this.#inputsAreHere(component)) void this.#obtain(component, wanted);
      else if (present !== null) store.setLibrary(component, { state: 'none' });
    }
  }

  /** A session may name files that have not been dropped on the page yet. */
  #inputsAreHere(component: ComponentName): boolean {
    const { store, studio, assets } = this.#services;
    const { model, libraryFile } = store.doc.components[component];
    const modelIsHere = model !== null && studio.meshOf(model.sha256) !== null;
    if (libraryFile) return assets.get(libraryFile.sha256) !== undefined && (model === null || modelIsHere);
    return modelIsHere;
  }

  async #obtain(component: ComponentName, key: string): Promise<void> {
    const { store } = this.#services;
    const abort = new AbortController();
    this.#running.set(component, abort);
    const startedAt = performance.now();
    store.setLibrary(component, { state: 'building', key });
    try {
      const { libraryFile } = store.doc.components[component];
      const facts = libraryFile
        ? await this.#openFile(component, libraryFile.sha256, store.doc, abort.signal)
        : await this.#build(component, abort);
      const seconds = libraryFile ? null : (performance.now() - startedAt) / 1000;
      if (!abort.signal.aborted) store.setLibrary(component, { state: 'ready', key, ...facts, seconds });
    } catch (error) {
      this.#stopped(component, key, error);
    }
  }

  async #openFile(component: ComponentName, sha256: string, doc: Doc, signal: AbortSignal): Promise<LibraryFacts> {
    const { assets, studio } = this.#services;
    const asset = assets.get(sha256);
    if (!asset) throw new Error(texts.said.library.noFile);
    const { model } = doc.components[component];
    const mesh = model && studio.meshOf(model.sha256);
    return this.#poser.call('open', { component, bytes: new Uint8Array(await asset.blob.arrayBuffer()), mesh }, { signal });
  }

  async #build(component: ComponentName, abort: AbortController): Promise<LibraryFacts> {
    const plan = libraryPlan(this.#services, component);
    const cancel = () => abort.abort();
    const { signal } = abort;
    return asJob(this.#services.store, { title: texts.said.library.job(titleOf(component)), unit: texts.said.library.views, total: 0, cancel }, async (onProgress) => {
      const bytes = await this.#pool.build(plan, { signal, onProgress });
      return this.#poser.call('open', { component, bytes, mesh: plan.mesh }, { signal, transfer: [bytes.buffer] });
    });
  }

  #stopped(component: ComponentName, key: string, error: unknown): void {
    const { store } = this.#services;
    const library = store.ui.libraries[component];
    // Another one has been asked for in the meantime.
    if (library.state !== 'building' || library.key !== key) return;
    const calledOff = error instanceof Aborted;
    const reason = calledOff ? texts.said.library.calledOff : sentenceOf(error);
    store.setLibrary(component, { state: 'stopped', key, reason });
    if (calledOff) store.say('info', texts.said.library.saidCalledOff(texts.component[component]));
    else store.say('error', texts.said.library.failed(titleOf(component), reason));
  }
}
