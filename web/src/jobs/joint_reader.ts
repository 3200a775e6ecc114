import type { Candidate } from '../document/types';
import { type JointNumbers, NO_NUMBERS } from '../results/joint_curves';
import { type JointAsked, jointAsked, jointAskedIn, type JointFrame } from '../results/motion';
import { COMPONENT_NAMES } from '../terms/component';
import { Aborted, type Bridge, WorkerStopped } from '../workers/bridge';
import type { JointFacts, JointModels, JointText, PoseText, PublishedFilm } from '../workers/protocol/joint';
import type { PoseProtocol } from '../workers/protocol/pose';
import { sentenceOf, type Services } from './services';

/** Frames that are asked for at once: other work for the worker waits no longer than for these. */
const AT_ONCE = 32;

interface Known extends Pick<JointFrame, 'femur' | 'tibia'> {
  readonly row: Float64Array;
  readonly impossible: string | null;
  readonly originsApart: number | null;
}

/** Works out the numbers of the joint while somebody looks at them: of each frame once, and again when a pose of it changes. */
export class JointReader {
  readonly #services: Services;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  /** Models, axes and side that the worker has open, and what they give; null while it has none. */
  #open: { readonly key: string; readonly facts: JointFacts } | null = null;
  /** What the numbers below rest on. */
  #key = '';
  readonly #known = new Map<string, Known>();
  /** What the worker refused is not asked again: joints by their keys, frames by their poses, the tibial ones by the femoral ones. */
  readonly #refusedJoints = new Set<string>();
  readonly #refusedPairs = new WeakMap<Candidate, WeakSet<Candidate>>();
  /** Femoral poses of frames that were refused together: each is asked by itself. */
  readonly #alone = new WeakSet<Candidate>();
  #stops = 0;
  #busy = false;
  #shown: { readonly asked: JointAsked; readonly known: number; readonly numbers: JointNumbers } | null = null;
  /** Counts what became known. */
  #version = 0;

  constructor(services: Services, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#services = services;
    this.#worker = worker;
    services.store.subscribe(() => void this.#look());
  }

  /** All that is known now of the document's joint; the same object as long as nothing changes. */
  get numbers(): JointNumbers {
    const asked = jointAsked(this.#services.store.doc);
    if (!asked || !this.#open || this.#open.key !== keyOf(asked) || this.#key !== this.#open.key) return NO_NUMBERS;
    if (this.#shown?.asked !== asked || this.#shown.known !== this.#version) {
      const of = new Map<string, Float64Array>();
      const impossible = new Map<string, string>();
      let originsApart: number | null = null;
      for (const { id } of asked.frames) {
        const known = this.#known.get(id);
        if (known) of.set(id, known.row);
        if (known?.impossible) impossible.set(id, known.impossible);
        else originsApart ??= known?.originsApart ?? null;
      }
      const numbers = { ...this.#open.facts, of, impossible, originsApart, waiting: this.#missing(asked).length };
      this.#shown = { asked, known: this.#version, numbers };
    }
    return this.#shown.numbers;
  }

  /** The numbers of one frame, by the names of their columns; null while they are not known, or where no knee has them. */
  rowOf(frameId: string): ReadonlyMap<string, number> | null {
    const here = this.#here(frameId);
    if (!here || here.known.impossible !== null) return null;
    return new Map(here.facts.columns.map((name, at) => [name, here.known.row[at] ?? NaN]));
  }

  /** Why no knee has the numbers of one frame, a sentence without its full stop; null where one may have them, or they are not known. */
  impossibleIn(frameId: string): string | null {
    return this.#here(frameId)?.known.impossible ?? null;
  }

  /** What the femur's flange says of the side of the body, where it tells the other one; null while the numbers of this frame are not known. */
  otherSideIn(frameId: string): string | null {
    return this.#here(frameId)?.facts.otherSide ?? null;
  }

  #here(frameId: string): { readonly known: Known; readonly facts: JointFacts } | null {
    const asked = jointAskedIn(this.#services.store.doc, frameId);
    const known = this.#known.get(frameId);
    if (!asked || !known || !this.#open || this.#key !== keyOf(asked) || this.#missing(asked).length > 0) return null;
    return { known, facts: this.#open.facts };
  }

  /** Works the numbers of one frame out, if they are not known. False where they cannot be yet: something else is being worked out, or models are on their way. */
  lookAt(frameId: string): Promise<boolean> {
    return this.#lookAt(jointAskedIn(this.#services.store.doc, frameId));
  }

  /** A text of the joint whose numbers are known, by the core. */
  publish(film: PublishedFilm, what: JointText): Promise<string> {
    return this.#worker.call('publish', { film, what });
  }

  figurePdf(film: PublishedFilm): Promise<Uint8Array<ArrayBuffer>> {
    return this.#worker.call('figurePdf', film);
  }

  poseText(text: PoseText): Promise<string> {
    return this.#worker.call('poseText', text);
  }

  #missing(asked: JointAsked): readonly JointFrame[] {
    return asked.frames.filter(({ id, femur, tibia }) => {
      const known = this.#known.get(id);
      return (known?.femur !== femur || known.tibia !== tibia) && !this.#refusedPairs.get(femur)?.has(tibia);
    });
  }

  async #look(): Promise<void> {
    const { store } = this.#services;
    if (store.ui.joint.open || store.ui.popover === 'export') await this.#lookAt(jointAsked(store.doc));
  }

  /** Whether there is an answer, be it that there is none. */
  async #lookAt(asked: JointAsked | null): Promise<boolean> {
    const { store } = this.#services;
    if (!asked || asked.frames.length === 0) return true;
    if (this.#busy || !this.#hasMeshes(asked)) return false;
    const key = keyOf(asked);
    const frames = this.#open?.key === key && this.#key === key ? this.#missing(asked) : asked.frames;
    if (frames.length === 0 || this.#refusedJoints.has(key)) return true;
    const some = this.#some(frames);
    this.#busy = true;
    try {
      await this.#workOut(asked, key, some);
      return true;
    } catch (error) {
      return this.#failed(error, key, some);
    } finally {
      this.#busy = false;
      // No part of the state: the views are notified, and the rest is looked at.
      this.#version += 1;
      store.show({});
    }
  }

  /** The next that are asked for together. */
  #some(frames: readonly JointFrame[]): readonly JointFrame[] {
    const first = frames.findIndex(({ femur }) => this.#alone.has(femur));
    return frames.slice(0, first < 0 ? AT_ONCE : Math.min(AT_ONCE, Math.max(1, first)));
  }

  async #workOut(asked: JointAsked, key: string, frames: readonly JointFrame[]): Promise<void> {
    if (this.#open?.key !== key) {
      this.#open = null;
      this.#open = { key, facts: await this.#worker.call('openJoint', this.#models(asked), { lane: 'film' }) };
    }
    if (this.#key !== key) this.#known.clear();
    this.#key = key;
    const uncertain = ({ pose, deviations }: Candidate) => ({ pose, deviations });
    const { numbers, impossible, originsApart } = await this.#worker.call('joint', frames.map(({ femur, tibia }) => ({ femur: uncertain(femur), tibia: uncertain(tibia) })), { lane: 'film' });
    const width = numbers.length / frames.length;
    frames.forEach(({ id, femur, tibia }, at) => {
      const row = numbers.subarray(at * width, (at + 1) * width);
      this.#known.set(id, { femur, tibia, row, impossible: impossible[at] ?? null, originsApart: originsApart[at] ?? null });
    });
  }

  /** What a stopped worker held is gone, and it is opened anew: twice, because this may be what stops it. False where it may be asked again. */
  #failed(error: unknown, key: string, frames: readonly JointFrame[]): boolean {
    const wasOpen = this.#open?.key === key;
    if (error instanceof WorkerStopped) this.#open = null;
    if (error instanceof Aborted || (error instanceof WorkerStopped && ++this.#stops < 3)) return false;
    if (wasOpen && frames.length > 1) {
      frames.forEach(({ femur }) => this.#alone.add(femur));
      return false;
    }
    if (wasOpen) frames.forEach((frame) => this.#refuse(frame));
    else this.#refusedJoints.add(key);
    this.#services.store.say('error', sentenceOf(error));
    return true;
  }

  /** What was known of it is of the poses before. */
  #refuse({ id, femur, tibia }: JointFrame): void {
    this.#known.delete(id);
    const refused = this.#refusedPairs.get(femur) ?? new WeakSet();
    this.#refusedPairs.set(femur, refused.add(tibia));
  }

  #hasMeshes({ models }: JointAsked): boolean {
    return COMPONENT_NAMES.every((component) => models[component] === null || this.#services.studio.meshOf(models[component]) !== null);
  }

  #models({ side, axes, models }: JointAsked): JointModels {
    const { studio } = this.#services;
    const mesh = (sha256: string | null) => (sha256 === null ? null : studio.meshOf(sha256));
    return { side, femur: { mesh: mesh(models.femur), axes: axes.femur }, tibia: { mesh: mesh(models.tibia), axes: axes.tibia } };
  }
}

function keyOf({ side, axes, models }: JointAsked): string {
  return JSON.stringify([side, axes, models]);
}
