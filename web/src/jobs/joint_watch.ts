import { knownAxes } from '../document/axes';
import { withAsides } from '../document/asides';
import { type Candidate, cellOf, chosenCandidate, type Doc } from '../document/types';
import { COMPONENT_NAMES } from '../terms/component';
import { Aborted, type Bridge } from '../workers/bridge';
import type { JointPart, LyingPose } from '../workers/protocol/joint';
import type { PoseProtocol } from '../workers/protocol/pose';
import type { Services } from './services';

/** Poses of both components in a frame, null where there is none. */
type Pair = readonly [Candidate | null, Candidate | null];

/**
 * Sees to it that poses whose components lie beside each other as in no knee are doubtful, as where a picture is mirrored: each fits by
 * itself. The core says so, over the film or of a frame; it is said anew whenever a pose has changed, and is no unit of undo.
 */
export class JointWatch {
  readonly #services: Services;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  /** What was asked last, and of which models. */
  #asked: { readonly models: string; readonly pairs: readonly Pair[] } = { models: '', pairs: [] };
  #busy = false;
  #said: string | null = null;
  /** What is still to be said: it does not take the place of what is being said. */
  #toSay: string | null = null;

  constructor(services: Services, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#services = services;
    this.#worker = worker;
    services.store.subscribe(() => {
      this.#say();
      void this.#look();
    });
  }

  async #look(): Promise<void> {
    const { doc, ui } = this.#services.store;
    const models = modelsOf(doc);
    // While a film is followed poses change with every frame, and a click would have to wait behind as many questions.
    if (this.#busy || models === null || ui.jobs.length > 0) return;
    const pairs = pairsOf(doc);
    if (models === this.#asked.models && alike(pairs, this.#asked.pairs)) return;
    const parts = this.#partsOf(doc);
    if (!parts) return;
    if (!pairs.some(([femur, tibia]) => femur && tibia)) return this.#services.store.amend((doc) => withAsides(doc, []));
    this.#busy = true;
    this.#asked = { models, pairs };
    try {
      const [femur, tibia] = parts;
      const frames = pairs.map(([femur, tibia]) => ({ femur: lying(femur), tibia: lying(tibia) }));
      const told = await this.#worker.call('lyingBeside', { key: models, femur, tibia, frames }, { lane: 'idle' });
      this.#take(told);
    } catch (error) {
      if (error instanceof Aborted) this.#asked = { models: '', pairs: [] };
    } finally {
      this.#busy = false;
      queueMicrotask(() => void this.#look());
    }
  }

  /** What was told of poses that have changed meanwhile is not taken: they are asked about next. */
  #take(told: readonly (string | null)[]): void {
    const { store } = this.#services;
    if (!alike(pairsOf(store.doc), this.#asked.pairs)) return;
    store.amend((doc) => withAsides(doc, told));
    const first = told.find((sentence) => sentence !== null) ?? null;
    if (first === null || this.#said === null) this.#toSay = first;
    this.#said = first;
    this.#say();
  }

  #say(): void {
    const { store } = this.#services;
    const sentence = this.#toSay;
    if (sentence === null || store.ui.notice !== null) return;
    this.#toSay = null;
    store.say('info', sentence.endsWith('?') ? sentence : `${sentence}.`);
  }

  #partsOf({ components }: Doc): readonly [JointPart, JointPart] | null {
    const [femur, tibia] = COMPONENT_NAMES.map((component) => {
      const { model } = components[component];
      const [axes, mesh] = [knownAxes(components[component]), model && this.#services.studio.meshOf(model.sha256)];
      return axes && mesh ? { mesh, axes } : null;
    });
    return femur && tibia ? [femur, tibia] : null;
  }
}

function lying(candidate: Candidate | null): LyingPose | null {
  return candidate && { pose: candidate.pose, depth: candidate.deviations?.z ?? null };
}

/** Null while a model or its axes are missing. */
function modelsOf({ components }: Doc): string | null {
  const known = COMPONENT_NAMES.map((component) => {
    const [axes, model] = [knownAxes(components[component]), components[component].model];
    return axes && model ? [model.sha256, axes] : null;
  });
  return known.every((one) => one !== null) ? JSON.stringify(known) : null;
}

function pairsOf(doc: Doc): readonly Pair[] {
  return doc.frames.map(({ id }) => [chosenCandidate(cellOf(doc, id, 'femur')), chosenCandidate(cellOf(doc, id, 'tibia'))]);
}

function alike(some: readonly Pair[], others: readonly Pair[]): boolean {
  return some.length === others.length && some.every(([femur, tibia], at) => femur === others[at]![0] && tibia === others[at]![1]);
}
