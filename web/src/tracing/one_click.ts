import { oneClickOutline } from './one_click_result';
import type { Place } from '../document/command';
import { CONSTANTS, filmNumbers } from '../document/film';
import { currentPlace } from '../document/store';
import { cellOf, type FrameEntry } from '../document/types';
import { framePoint, type FramePoint, pointsFrom } from '../geometry/points';
import { Aborted, type Bridge } from '../workers/bridge';
import { cameraOf, poseKey } from '../results/keys';
import type { PoseProtocol } from '../workers/protocol/pose';
import type { OneClickFacts, OneClickInput } from '../workers/protocol/one_click';
import { asJob, sentenceOf, type Services } from '../jobs/services';
import { surroundingsOf } from '../results/surroundings';
import { texts } from '../texts/texts';
import { flat } from './pixels';

/** A click inside the implant, or opposite corners of a rough box. */
export type Prompt = readonly [FramePoint] | readonly [FramePoint, FramePoint];

/** Asks the pose worker for a first outline and pose, one at a time; a newer click calls the older one off. */
export class OneClick {
  readonly #services: Services;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  #running: AbortController | null = null;

  constructor(services: Services, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#services = services;
    this.#worker = worker;
  }

  async ask(prompt: Prompt, frame: FrameEntry, bright: boolean): Promise<void> {
    const { store } = this.#services;
    const place = currentPlace(store.state);
    this.#running?.abort();
    if (!place) return;
    const running = new AbortController();
    this.#running = running;
    try {
      await this.#find(prompt, place, frame, bright, running);
    } catch (error) {
      if (!(error instanceof Aborted)) store.say('error', sentenceOf(error));
    } finally {
      if (this.#running === running) this.#running = null;
    }
  }

  async #find(prompt: Prompt, place: Place, frame: FrameEntry, bright: boolean, running: AbortController): Promise<void> {
    const { store } = this.#services;
    const { component } = place;
    const input = this.#input(prompt, place, frame, bright);
    const before = cellOf(store.doc, frame.id, component).outline;
    const key = input.withModel ? poseKey(store.doc, component, frame) : null;
    const title = texts.tracing.said.oneClickJob(texts.componentTitle[component]);
    const job = { title, unit: texts.tracing.said.percent, total: 0, cancel: () => running.abort() };
    const answer = await asJob(store, job, (report) =>
      this.#worker.call('oneClick', input, {
        signal: running.signal,
        transfer: [input.frame.pixels.buffer],
        onProgress: ({ fraction }) => report(Math.round(100 * fraction), 100),
      }),
    );
    const changed = cellOf(store.doc, frame.id, component).outline !== before;
    if (changed) return store.say('info', texts.tracing.said.changedMeanwhile);
    this.#take(answer, place, key, input.film);
  }

  #input(prompt: Prompt, { component }: Place, frame: FrameEntry, bright: boolean): OneClickInput {
    const { store, studio } = this.#services;
    const camera = cameraOf(store.doc, frame);
    if (!camera) throw new Error(texts.tracing.said.needsCalibration);
    const pixels = studio.framePixels(frame.id);
    if (!pixels) throw new Error(texts.tracing.said.noPixels(frame.name));
    if (camera.distortion) throw new Error(texts.calibrate.distortedFrame);
    const other = cellOf(store.doc, frame.id, component === 'femur' ? 'tibia' : 'femur').outline;
    return {
      component,
      camera,
      frame: { pixels, width: frame.width, height: frame.height },
      prompt: promptNumbers(prompt),
      bright,
      avoid: other?.closed ? flat(other.points) : null,
      withModel: store.ui.libraries[component].state === 'ready',
      around: surroundingsOf(store.doc, frame.id, component),
      film: filmNumbers(store.doc, component),
    };
  }

  #take(answer: OneClickFacts, place: Place, key: string | null, film: OneClickInput['film']): void {
    const { store } = this.#services;
    const outlines = answer.outlines.map((numbers) => ({ points: pointsFrom(numbers), closed: true, unknownSides: [] }));
    const onFrame = { film: (answer.corrected && film?.slice(0, CONSTANTS)) || null };
    store.perform(oneClickOutline(place, outlines, { ...answer, onFrame }, key));
    store.show({ selectedPoint: null });
    // What was refused stands in the cell and the bottom line as long as it does.
    if (answer.match?.refusal == null) store.say('info', answer.sentence);
  }
}

function promptNumbers([a, b]: Prompt): Float64Array<ArrayBuffer> {
  if (!b) return Float64Array.of(a.column, a.row);
  const least = framePoint(Math.min(a.column, b.column), Math.min(a.row, b.row));
  const most = framePoint(Math.max(a.column, b.column), Math.max(a.row, b.row));
  return Float64Array.of(least.column, least.row, most.column, most.row);
}
