import { knownAxes } from '../document/axes';
import { withAsides } from '../document/asides';
import { filmNumbers } from '../document/film';
import { type Candidate, cellOf, chosenCandidate, type Doc, type KneeDoubt, verdictAlone } from '../document/types';
import { cameraOf } from '../results/keys';
import { COMPONENT_NAMES } from '../terms/component';
import { asSentence } from '../texts/sentences';
import { Aborted, type Bridge } from '../workers/bridge';
import type { JointPart, KneeFilm, LyingBeside, LyingPose } from '../workers/protocol/joint';
import type { PoseProtocol } from '../workers/protocol/pose';
import { frameAt } from './beside_poses';
import type { Services } from './services';

/** Poses of both components in a frame, null where there is none. */
type Pair = readonly [Candidate | null, Candidate | null];

/** What was looked at as if it were flipped. */
interface Flipped {
  /** Of which models and camera. */
  readonly of: string;
  /** Frames that had both poses then. */
  readonly known: number;
  /** Frames that were looked at, with the poses that they were looked at from. */
  readonly pairs: ReadonlyMap<number, Pair>;
}

/** The core looks at so many frames of a film: where there were fewer, it is asked again once there are more. */
const ENOUGH = 3;

/**
 * Sees to it that poses whose components lie beside each other as in no knee are doubtful, and those that both fit better with the picture
 * flipped, as where it is mirrored: each fits by itself. The core says so, over the film or of a frame; it is said anew whenever a pose has
 * changed, and is no unit of undo.
 */
export class JointWatch {
  readonly #services: Services;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  /** What was asked last, and of which models. */
  #asked: { readonly models: string; readonly pairs: readonly Pair[] } = { models: '', pairs: [] };
  #flipped: Flipped = { of: '', known: 0, pairs: new Map() };
  #busy = false;
  #said: string | null = null;
  /** What was told of these models last: kept with the work, and beside it where undo leads to a document from before. */
  #finding: KneeDoubt | null = null;
  /** What is still to be said: it does not take the place of what is being said, but for that a pose is good. */
  #toSay: string | null = null;

  constructor(services: Services, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#services = services;
    this.#worker = worker;
    services.store.subscribe(() => {
      this.#say();
      void this.#look();
    });
    void this.#look();
  }

  async #look(): Promise<void> {
    const { doc, ui } = this.#services.store;
    const models = modelsOf(doc);
    // While a film is followed poses change with every frame, and a click would have to wait behind as many questions.
    if (this.#busy || models === null || ui.jobs.length > 0) return;
    const pairs = pairsOf(doc);
    const isAsked = models === this.#asked.models && alike(pairs, this.#asked.pairs);
    // A hand that moves a model asks with every step, and looks cost more than questions.
    if (isAsked && (ui.tool === 'pose' || this.#isLookedAt(doc, models, pairs))) return this.#keepFinding();
    // Work that came back: what was told of it is not taken back before it was looked at as then.
    const cameBack = models !== this.#asked.models && doc.kneeDoubt?.models === models;
    const parts = this.#partsOf(doc);
    if (!parts) return;
    if (!pairs.some(([femur, tibia]) => femur && tibia)) return this.#services.store.amend((doc) => withAsides(doc, []));
    this.#busy = true;
    if (models !== this.#asked.models) this.#finding = doc.kneeDoubt;
    this.#asked = { models, pairs };
    try {
      const [femur, tibia] = parts;
      const frames = pairs.map(([femur, tibia]) => ({ femur: lying(femur), tibia: lying(tibia) }));
      const film = { key: models, femur, tibia, frames };
      if (isAsked || cameBack) await this.#lookFlipped(doc, film, pairs);
      this.#take(await this.#worker.call('lyingBeside', film, { lane: 'idle' }));
    } catch (error) {
      if (error instanceof Aborted) this.#asked = { models: '', pairs: [] };
    } finally {
      this.#busy = false;
      queueMicrotask(() => void this.#look());
    }
  }

  #isLookedAt(doc: Doc, models: string, pairs: readonly Pair[]): boolean {
    const of = flippedOf(doc, models);
    const { known, pairs: looked } = this.#flipped;
    if (of === null) return true;
    const isSame = this.#flipped.of === of && [...looked].every(([frame, pair]) => alike([pair], pairs.slice(frame, frame + 1)));
    return isSame && (known >= ENOUGH || known >= knownIn(pairs));
  }

  /** Looks at the frames that the core wants, as if they were flipped. */
  async #lookFlipped(doc: Doc, film: KneeFilm, pairs: readonly Pair[]): Promise<void> {
    const looked = new Map<number, Pair>();
    // Also where it fails: the same question would fail again.
    this.#flipped = { of: flippedOf(doc, film.key) ?? '', known: knownIn(pairs), pairs: looked };
    for (let look = await this.#worker.call('beginFlipped', film, { lane: 'idle' }); look !== null; ) {
      const { frame, component } = look;
      const camera = cameraOf(doc, doc.frames[frame] ?? null);
      if (!camera) return;
      const { frameId: _, ...pixels } = await frameAt(this.#services, doc.frames, frame);
      looked.set(frame, pairs[frame]!);
      look = await this.#worker.call('lookFlipped', { ...pixels, camera, film: filmNumbers(doc, component) }, { lane: 'idle', transfer: [pixels.pixels.buffer] });
    }
  }

  /** What was told of poses that have changed meanwhile is not taken: they are asked about next. */
  #take(told: readonly (LyingBeside | null)[]): void {
    const { store } = this.#services;
    if (!alike(pairsOf(store.doc), this.#asked.pairs)) return;
    store.amend((doc) => withAsides(doc, told));
    const first = told.find((one) => one !== null)?.sentence ?? this.#toldBefore();
    this.#finding = first === null ? null : { models: this.#asked.models, sentence: first };
    this.#keepFinding();
    if (this.#sayInstead(first)) return;
    const { notice } = store.ui;
    // Its numbers change as more is known: it is not said twice in one line.
    const isSaid = this.#said !== null && notice?.text.includes(asSentence(this.#said));
    if (first === null || this.#said === null || (notice?.of === 'film' && !isSaid)) this.#toSay = first;
    else if (isSaid) return;
    this.#said = first;
    this.#say();
  }

  /** What stands in the line of the poses as they were gives way to what is so of them now, perhaps nothing. */
  #sayInstead(now: string | null): boolean {
    const { store } = this.#services;
    const { notice } = store.ui;
    const said = this.#said === null ? null : asSentence(this.#said);
    if (said === null || now === this.#said || !notice?.text.endsWith(said)) return false;
    const text = [notice.text.slice(0, -said.length).trim(), now === null ? '' : asSentence(now)].filter((part) => part !== '').join(' ');
    this.#said = now;
    if (text === '') store.quiet();
    else store.say(notice.kind, text, undefined, notice.of);
    return true;
  }

  #keepFinding(): void {
    const { store } = this.#services;
    const kneeDoubt = this.#finding;
    const { models, sentence } = store.doc.kneeDoubt ?? {};
    if (models !== kneeDoubt?.models || sentence !== kneeDoubt?.sentence) store.amend((doc) => ({ ...doc, kneeDoubt }));
  }

  /** A film that was followed to no good knee does not take back what its first poses told: nothing has shown another cause. */
  #toldBefore(): string | null {
    const { doc } = this.#services.store;
    const isGood = (frameId: string) => COMPONENT_NAMES.every((component) => verdictAlone(cellOf(doc, frameId, component).result)?.word === 'good');
    return this.#finding?.models === this.#asked.models && !doc.frames.some(({ id }) => isGood(id)) ? this.#finding.sentence : null;
  }

  #say(): void {
    const { store } = this.#services;
    const { notice } = store.ui;
    const sentence = this.#toSay;
    if (sentence === null || (notice !== null && notice.of === undefined)) return;
    this.#toSay = null;
    // It stands there already.
    if (notice?.text.endsWith(asSentence(sentence))) return;
    const before = notice?.of === 'film' ? `${notice.text} ` : '';
    store.say(notice?.kind ?? 'info', before + asSentence(sentence), undefined, notice?.of);
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

/** What looks at a film as if it were flipped rest on, beside the poses; null where frames cannot be looked at. */
function flippedOf(doc: Doc, models: string): string | null {
  const camera = cameraOf(doc, doc.frames[0] ?? null);
  return camera && !camera.distortion ? `${models} ${camera.text} ${camera.width} ${camera.height}` : null;
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

function knownIn(pairs: readonly Pair[]): number {
  return pairs.filter(([femur, tibia]) => femur && tibia).length;
}

function pairsOf(doc: Doc): readonly Pair[] {
  return doc.frames.map(({ id }) => [chosenCandidate(cellOf(doc, id, 'femur')), chosenCandidate(cellOf(doc, id, 'tibia'))]);
}

function alike(some: readonly Pair[], others: readonly Pair[]): boolean {
  return some.length === others.length && some.every(([femur, tibia], at) => femur === others[at]![0] && tibia === others[at]![1]);
}
