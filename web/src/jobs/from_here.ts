import type { Place } from '../document/command';
import { CONSTANTS, filmNumbers } from '../document/film';
import { indexOfFrame } from '../document/frame_index';
import { bare, takeHandFit, type HandFit } from '../document/hand_poses';
import { type Candidate, type Cell, cellOf, chosenCandidate, type Doc, type FrameEntry } from '../document/types';
import type { Locks, PoseNumbers } from '../geometry/pose_numbers';
import { COMPONENT_NAMES } from '../terms/component';
import { texts } from '../texts/texts';
import { Aborted, type Bridge } from '../workers/bridge';
import type { FitFacts, OnFrame } from '../workers/protocol/by_hand';
import { cameraOf, poseKeyAt } from '../results/keys';
import { aroundHand } from '../results/surroundings';
import { flatten } from './poser';
import type { PoseProtocol } from '../workers/protocol/pose';
import { asJob, sentenceOf, type Services } from './services';

/** The six numbers in the order in which they cross into WASM. */
export const FIELDS = ['x', 'y', 'z', 'zRot', 'xRot', 'yRot'] as const satisfies readonly (keyof PoseNumbers)[];

/** Who knows what the film makes of a component. */
export interface Readiness {
  ready(): Promise<void>;
}

/**
 * Refines from the pose on view: against the closed outline, or against the frame where there is none. The answer is a
 * command, so that it can be undone, and is dropped when the pose was changed meanwhile.
 */
export class FromHere {
  readonly #services: Services;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  readonly #film: Readiness;
  #abort: AbortController | null = null;

  constructor(services: Services, worker: Pick<Bridge<PoseProtocol>, 'call'>, film: Readiness) {
    this.#services = services;
    this.#worker = worker;
    this.#film = film;
  }

  async refine(place: Place): Promise<void> {
    const { store } = this.#services;
    const start = chosenCandidate(cellOf(store.doc, place.frameId, place.component));
    if (!start) return store.sayAt(place, 'info', texts.hand.said.noPose);
    if (store.ui.libraries[place.component].state !== 'ready') {
      return store.sayAt(place, 'info', texts.hand.said.noLibrary(texts.component[place.component]));
    }
    this.#abort?.abort();
    const abort = (this.#abort = new AbortController());
    try {
      const { locks } = store.ui.hand;
      const key = poseKeyAt(store.doc, place);
      const { outline } = cellOf(store.doc, place.frameId, place.component);
      const fit = await this.#ask(place, start, locks, abort);
      const isAsBefore = poseKeyAt(store.doc, place) === key && cellOf(store.doc, place.frameId, place.component).outline === outline;
      if (!isAsBefore) return store.sayAt(place, 'info', texts.hand.said.changed);
      this.#take(place, start, fit);
    } catch (error) {
      if (!(error instanceof Aborted)) store.sayAt(place, 'error', sentenceOf(error));
    }
  }

  #ask(place: Place, start: Candidate, locks: Locks, abort: AbortController): Promise<HandFit> {
    const title = texts.hand.job(texts.component[place.component]);
    const job = { title, unit: '', total: 0, cancel: () => abort.abort() };
    return asJob(this.#services.store, job, async () => {
      const isOnFrame = !cellOf(this.#services.store.doc, place.frameId, place.component).outline?.closed;
      // A pose that a person asked for does not change afterwards.
      if (isOnFrame) await this.#film.ready();
      if (abort.signal.aborted) throw new Aborted();
      const { doc } = this.#services.store;
      const { outline } = cellOf(doc, place.frameId, place.component);
      const known = outline?.closed ? null : filmNumbers(doc, place.component);
      const onFrame = outline?.closed ? null : { film: known?.slice(0, CONSTANTS) ?? null };
      const fit = outline?.closed ? await this.#onOutline(place, start, locks, abort.signal) : await this.#onFrame(place, start, locks, abort.signal);
      const against = outline?.closed
        ? texts.hand.fitOutline(fit.residual.toFixed(2))
        : texts.hand.fitFrame(fit.residual.toFixed(2), fit.bright);
      return { candidate: candidateOf(fit), reason: against + heldWords(locks), verdict: fit.verdict, onFrame };
    });
  }

  #onOutline(place: Place, { pose }: Candidate, locks: Locks, signal: AbortSignal): Promise<FitFacts> {
    const { doc } = this.#services.store;
    const { outline } = cellOf(doc, place.frameId, place.component);
    const camera = cameraOf(doc, frameOf(doc, place));
    if (!outline || !camera) throw new Error(texts.hand.said.noModel(texts.component[place.component]));
    const { component } = place;
    const input = { component, ...flatten(outline), camera, start: pose, locked: flagsOf(locks), around: aroundHand(doc, place) };
    return this.#worker.call('refineFrom', input, { signal });
  }

  async #onFrame(place: Place, { pose }: Candidate, locks: Locks, signal: AbortSignal): Promise<FitFacts> {
    const onFrame = await onFrameInput(this.#services, place);
    const input = { ...onFrame, start: pose, locked: flagsOf(locks), around: aroundHand(this.#services.store.doc, place) };
    return this.#worker.call('refineOnFrame', input, { signal, transfer: [onFrame.frame.pixels.buffer] });
  }

  #take(place: Place, start: Candidate, fit: HandFit): void {
    const { store } = this.#services;
    const cell: Cell = cellOf(store.doc, place.frameId, place.component);
    if (chosenCandidate(cell) !== start) return store.sayAt(place, 'info', texts.hand.said.changed);
    store.perform(takeHandFit(place, fit));
    store.say('info', fit.reason);
  }
}

/** The frame itself as what a pose is held against. Throws a sentence where it cannot be. */
export async function onFrameInput({ store, studio }: Services, { component, frameId }: Place): Promise<OnFrame> {
  const frame = await studio.framePixels(frameId);
  const { doc, ui } = store;
  const camera = cameraOf(doc, frameOf(doc, { component, frameId }));
  if (!camera) throw new Error(texts.hand.said.noModel(texts.component[component]));
  if (!frame) throw new Error(texts.hand.said.noPixels);
  if (camera.distortion) throw new Error(texts.calibrate.distortedFrame);
  const others = COMPONENT_NAMES.flatMap((other) => {
    const there = other !== component && ui.libraries[other].state === 'ready' && chosenCandidate(cellOf(doc, frameId, other));
    return there ? [{ component: other, pose: there.pose }] : [];
  });
  const { outline } = cellOf(doc, frameId, component);
  const unknown = outline?.closed && outline.unknownSides.length > 0 ? flatten(outline) : null;
  return { component, camera, frame, others, unknown, bright: ui.tracing.bright, film: filmNumbers(doc, component) };
}

function candidateOf({ pose, residual, drawn, deviations }: FitFacts): Candidate {
  return { ...bare(pose), residual, drawn, deviations };
}

export function frameOf(doc: Doc, place: Place): FrameEntry | null {
  return doc.frames[indexOfFrame(doc, place.frameId)] ?? null;
}

function flagsOf(locks: Locks): boolean[] {
  return FIELDS.map((field) => locks[field]);
}

function heldWords(locks: Locks): string {
  const held = FIELDS.filter((field) => locks[field]).map((field) => texts.hand.names[field]);
  return held.length > 0 ? ` ${texts.hand.held(texts.listed(held))}` : '';
}
