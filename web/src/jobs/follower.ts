import type { Place } from '../document/command';
import { filmNumbers } from '../document/film';
import { type Followed, takeFollowed, withoutSoFar, withSoFar } from '../document/followed';
import { currentFrame } from '../document/store';
import { cellOf, chosenCandidate, type FrameEntry, type Result } from '../document/types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { type Span, spanToFollow } from '../results/spans';
import { standingOf } from '../results/steps';
import { cameraOf } from '../results/keys';
import { COMPONENT_NAMES, type ComponentName, otherThan } from '../terms/component';
import { texts } from '../texts/texts';
import { Aborted, type Bridge } from '../workers/bridge';
import type { Femurs, FollowedFrame, FollowProtocol } from '../workers/protocol/follow';
import { aborted, frameAt, readBeside, subjectOf, unlessAborted } from './beside_poses';
import type { FilmLater } from './film_later';
import type { FirstPoses } from './first_poses';
import { type Looked, Progress } from './follow_progress';
import { asJob, sentenceOf, type Services } from './services';

type Worker = Pick<Bridge<FollowProtocol>, 'call' | 'dispose'>;

type Film = Pick<FilmLater, 'ready' | 'knowsBeside' | 'takeBeside'>;

/** A component with the frames that it is followed over. */
interface Part {
  readonly component: ComponentName;
  readonly worker: Worker;
  readonly span: Span;
  /** What was there in frames that were looked at. */
  readonly before: Map<string, readonly [Place, Result | null]>;
}

/**
 * Follows the components through the film from the frames that a person set, in a worker each, while the person goes on working.
 * What a person set never changes, and only what lies between frames that have changed is done again.
 */
export class Follower {
  readonly #services: Services;
  readonly #first: Pick<FirstPoses, 'open' | 'find'>;
  readonly #film: Film;
  readonly #workers: Readonly<Record<ComponentName, Worker>>;
  #abort: AbortController | null = null;

  constructor(services: Services, workers: Readonly<Record<ComponentName, Worker>>, first: Pick<FirstPoses, 'open' | 'find'>, film: Film) {
    this.#services = services;
    this.#workers = workers;
    this.#first = first;
    this.#film = film;
  }

  /** Begins, or where it is under way stops and keeps what there is. */
  async follow(): Promise<void> {
    if (this.#abort) return this.#abort.abort();
    const { store } = this.#services;
    const refusal = this.#refusal();
    if (refusal !== null) return store.say('info', refusal);
    const abort = (this.#abort = new AbortController());
    store.show({ following: true });
    try {
      const missing = await this.#begin(abort);
      if (!abort.signal.aborted) await this.#readFilm(abort);
      if (!abort.signal.aborted) await this.#follow(missing, abort);
    } catch (error) {
      if (!(error instanceof Aborted)) store.say('error', sentenceOf(error));
    } finally {
      this.#abort = null;
      // What a film needs, some tens of MB, is let go with its workers; the next call starts others.
      for (const component of COMPONENT_NAMES) this.#workers[component].dispose();
      store.show({ following: false });
    }
  }

  /** Finds what is set in no frame; gives what is nowhere. Waits for what the film tells of itself. */
  async #begin(abort: AbortController): Promise<readonly ComponentName[]> {
    const { store, studio } = this.#services;
    const isHere = (component: ComponentName) => studio.meshOf(store.doc.components[component].model?.sha256 ?? '') !== null;
    const unposed = standingOf(store.doc).unposed.filter(isHere);
    const cancel = () => abort.abort();
    const missing = unposed.length > 0 ? await this.#first.find(unposed, this.#workers, abort.signal, cancel) : [];
    await this.#filmReady(abort);
    return missing;
  }

  /** Reads the film beside the poses that components are followed from all through, so that the way does not depend on a single frame. */
  async #readFilm(abort: AbortController): Promise<void> {
    const { doc } = this.#services.store;
    if (doc.film.stated.constants) return;
    const lacking: Part[] = [];
    for (const part of this.#parts()) {
      const { free, given, isDoubtful } = part.span;
      const isAnew = free + given.length === doc.frames.length || filmNumbers(doc, part.component) === null;
      if (isAnew && !isDoubtful && !(await this.#film.knowsBeside(part.component))) lacking.push(part);
    }
    if (lacking.length === 0) return;
    const read = await readBeside(this.#services, lacking, abort);
    if (read.size === 0) return;
    for (const [component, beside] of read) await this.#film.takeBeside(component, beside);
    await this.#filmReady(abort);
  }

  /** When the film has told what it tells, and the poses that lead are corrected by that. */
  #filmReady(abort: AbortController): Promise<void> {
    const job = { title: texts.follow.estimating, unit: '', total: 0, cancel: () => abort.abort() };
    return asJob(this.#services.store, job, () => Promise.race([this.#film.ready(), aborted(abort.signal)]));
  }

  async #follow(missing: readonly ComponentName[], abort: AbortController): Promise<void> {
    const { store } = this.#services;
    const parts = this.#parts();
    const notFound = missing.map((component) => texts.follow.notFound(texts.component[component]));
    this.#sayNotFound(missing);
    if (parts.length === 0) return store.say(notFound.length > 0 ? 'error' : 'info', notFound.length > 0 ? notFound.join(' ') : this.#nothingToDo());
    const total = parts.reduce((sum, { span }) => sum + span.free + span.given.length, 0);
    const job = { title: texts.follow.job, unit: texts.follow.unit, total, cancel: () => abort.abort() };
    const found = await asJob(store, job, (report) => this.#all(parts, abort.signal, new Progress(report, total)));
    const before = parts.flatMap((part) => [...part.before.values()]);
    store.amend((doc) => withoutSoFar(doc, before));
    if (found.length > 0) store.perform(takeFollowed(found));
    const posed = found.filter(({ pose }) => pose).length;
    const done = texts.follow.done(posed, found.filter(isDoubtful).length, found.length - posed, abort.signal.aborted);
    store.say(notFound.length > 0 ? 'error' : 'info', [done, ...notFound].join(' '));
  }

  /** In the card of each component, where it was looked for; the bottom line has it with what was found. */
  #sayNotFound(missing: readonly ComponentName[]): void {
    const { store } = this.#services;
    const frame = currentFrame(store.state);
    for (const component of frame ? missing : []) {
      store.sayAt({ frameId: frame!.id, component }, 'error', texts.follow.notFound(texts.component[component]));
    }
  }

  /** Why the film cannot be followed; null where it can. */
  #refusal(): string | null {
    const { doc } = this.#services.store;
    const [first] = doc.frames;
    if (!first || doc.frames.length < 2) return texts.follow.oneFrame;
    if (doc.frames.some((frame) => frame.width !== first.width || frame.height !== first.height)) return texts.follow.sizes;
    const camera = cameraOf(doc, first);
    if (!camera) return texts.follow.noCalibration;
    return camera.distortion ? texts.calibrate.distortedFrame : null;
  }

  #nothingToDo(): string {
    const { doc } = this.#services.store;
    const isSet = (frame: FrameEntry) => COMPONENT_NAMES.some((component) => chosenCandidate(cellOf(doc, frame.id, component)));
    return doc.frames.some(isSet) ? texts.follow.allSet : texts.follow.noneSet;
  }

  #parts(): readonly Part[] {
    const { store, studio } = this.#services;
    return COMPONENT_NAMES.flatMap((component) => {
      const { model } = store.doc.components[component];
      const span = model && studio.meshOf(model.sha256) ? spanToFollow(store.doc, component) : null;
      return span ? [{ component, span, worker: this.#workers[component], before: new Map() }] : [];
    });
  }

  async #all(parts: readonly Part[], signal: AbortSignal, progress: Progress): Promise<readonly Followed[]> {
    await this.#bothSides(parts, signal, progress);
    if (signal.aborted) await Promise.all(parts.map(({ worker }) => worker.call('stop', null)));
    const depths = new Map<ComponentName, Float64Array<ArrayBuffer>>();
    for (const { component, worker } of parts) depths.set(component, await worker.call('depths', null));
    const found = parts.map(async (part) => {
      const other = depths.get(otherThan(part.component)) ?? new Float64Array();
      return this.#answers(part, await this.#compared(part, other, signal, progress), signal.aborted);
    });
    return (await Promise.all(found)).flat();
  }

  /**
   * Both components at once: the tibia's sides are chosen with the femur as it was followed, which hardly ever goes over to its other side
   * afterwards. Where it does, and that tells another side of the tibia, this is done again.
   */
  async #bothSides(parts: readonly Part[], signal: AbortSignal, progress: Progress): Promise<void> {
    const [femur, tibia] = COMPONENT_NAMES.map((name) => parts.find(({ component }) => component === name));
    const isFemurFollowed = femur ? this.#through(femur, signal, progress) : Promise.resolve();
    const early = isFemurFollowed.then(() => this.#femurs(femur));
    const femurDone = early.then(() => femur && this.#sides(femur, null, signal, progress));
    const tibiaDone = tibia && this.#through(tibia, signal, progress).then(async () => this.#sides(tibia, this.#known(await early), signal, progress));
    await Promise.all([femurDone, tibiaDone]);
    if (!femur || !tibia || signal.aborted) return;
    const femurs = this.#known(await this.#femurs(femur));
    await this.#look(tibia, await tibia.worker.call('standsWith', { femurs }), signal, progress.another);
  }

  /** The answer, doubtful frames with what they look like from the other side of the mirror. */
  async #compared(part: Part, otherDepths: Float64Array<ArrayBuffer>, signal: AbortSignal, progress: Progress): Promise<readonly FollowedFrame[]> {
    const film = await part.worker.call('conclude', { otherDepths });
    const frames = film.flatMap(({ state }, frame) => (state === 'doubtful' ? [frame] : []));
    if (frames.length === 0 || signal.aborted) return film;
    await this.#look(part, await part.worker.call('compare', { frames }), signal, progress.another);
    return part.worker.call('conclude', { otherDepths });
  }

  /** From the frames that are set over all others. */
  async #through(part: Part, signal: AbortSignal, progress: Progress): Promise<void> {
    const { component, worker, span } = part;
    const { store } = this.#services;
    const { doc } = store;
    const { mesh, camera } = subjectOf(this.#services, component);
    const { first, last, given } = span;
    const searches = await this.#first.open(component, worker);
    const begin = { mesh, camera, frames: doc.frames.length, first, last, given, searches, film: filmNumbers(doc, component) };
    await this.#look(part, await worker.call('begin', begin), signal, progress.followed);
    // Which side is the right one may depend on the femur; what a frame says of both does not, and is looked at meanwhile.
    if (!signal.aborted) await this.#look(part, await worker.call('seeSides', null), signal, progress.another);
  }

  async #sides(part: Part, femurs: Femurs | null, signal: AbortSignal, progress: Progress): Promise<void> {
    if (!signal.aborted) await this.#look(part, await part.worker.call('sides', { femurs }), signal, progress.another);
  }

  /** Shows the frames that the worker asks for; stops between two of them. What is found fills its cell at once. */
  async #look(part: Part, first: number | null, signal: AbortSignal, looked: Looked): Promise<void> {
    for (let next = first; next !== null && !signal.aborted; ) {
      const at = next;
      const { frameId, ...input } = await frameAt(this.#services, at);
      const seen = await part.worker.call('look', input, { signal, transfer: [input.pixels.buffer] }).catch(unlessAborted);
      if (!seen) return;
      next = seen.next;
      if (seen.pose) this.#fill(part, at, frameId, seen.pose);
      looked(part.component, at);
    }
  }

  #fill({ component, span, before }: Part, frame: number, frameId: string, pose: PoseNumbers): void {
    const { store } = this.#services;
    if (span.given.some((one) => one.frame === frame)) return;
    const place = { frameId, component };
    if (!before.has(frameId)) before.set(frameId, [place, cellOf(store.doc, frameId, component).result]);
    store.amend((doc) => withSoFar(doc, place, pose, span.key(frame)));
  }

  /** As far as they are followed; what is not followed is as it is shown. */
  async #femurs(femur: Part | undefined): Promise<readonly (PoseNumbers | null)[]> {
    const shown = this.#shownPoses('femur');
    const film = (await femur?.worker.call('conclude', { otherDepths: new Float64Array() })) ?? [];
    if (!femur) return shown;
    return film.map(({ pose }, frame) => pose ?? shown[frame] ?? null);
  }

  #shownPoses(component: ComponentName): readonly (PoseNumbers | null)[] {
    const { doc } = this.#services.store;
    return doc.frames.map((frame) => chosenCandidate(cellOf(doc, frame.id, component))?.pose ?? null);
  }

  /** Null where the axes are not known: then edges alone decide. */
  #known(poses: readonly (PoseNumbers | null)[]): Femurs | null {
    const { femur, tibia } = this.#services.store.doc.components;
    const areTold = femur.axes && tibia.axes && femur.axes.told !== 'nothing' && tibia.axes.told !== 'nothing';
    if (!areTold || !femur.axes || !tibia.axes || poses.every((pose) => pose === null)) return null;
    return { poses, axes: femur.axes.directions, own: tibia.axes.directions };
  }

  #answers({ component, span }: Part, film: readonly FollowedFrame[], stopped: boolean): readonly Followed[] {
    const { doc } = this.#services.store;
    // The film has not told of what leads before it is followed to its end.
    const isLeader = (frame: number) => !stopped && span.given.some((one) => one.frame === frame && !one.isSet);
    const left = (frame: number) => (stopped ? null : (film[frame]?.pose ?? null));
    const led = span.isDoubtful || (stopped && span.given.every(({ isDoubtful }) => isDoubtful));
    const isGiven = (frame: number) => span.given.some((one) => one.frame === frame);
    return film.flatMap((one, index) => {
      const frame = doc.frames[index];
      const isInside = index >= span.first && index <= span.last && (!isGiven(index) || isLeader(index));
      // What was not reached before somebody stopped it is as it was.
      if (!frame || !isInside || (stopped && one.state === 'unsolved')) return [];
      const place: Place = { frameId: frame.id, component };
      const { pose, deviations, residual, badness, rival } = one;
      const { because } = one;
      const doubtful = one.state === 'doubtful';
      return [{ place, pose, deviations, residual, badness, rival, led, isLeader: isLeader(index), because, doubtful, from: span.key(index, left) }];
    });
  }
}

function isDoubtful({ pose, doubtful, led }: Followed): boolean {
  return pose !== null && (doubtful || led);
}
