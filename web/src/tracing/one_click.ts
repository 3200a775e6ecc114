import { oneClickOutline } from './one_click_result';
import type { Place } from '../document/command';
import { CONSTANTS, filmNumbers } from '../document/film';
import { gaveWay } from '../document/followed';
import { indexOfFrame } from '../document/frame_index';
import { checkState, markOf } from '../document/marks';
import type { Store } from '../document/store';
import { cellKey, cellOf, chosenCandidate, type FrameEntry, isByHand, verdictOf } from '../document/types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { framePoint, type FramePoint, pointsFrom } from '../geometry/points';
import { Aborted, type Bridge } from '../workers/bridge';
import { cameraOf, poseKey } from '../results/keys';
import type { FramePixels } from '../workers/protocol/frame_pixels';
import type { PoseProtocol } from '../workers/protocol/pose';
import type { OneClickFacts, OneClickInput } from '../workers/protocol/one_click';
import { libraryReady } from '../jobs/library_ready';
import { asJob, sentenceOf, type Services } from '../jobs/services';
import { misfitsBeside } from '../results/film';
import { otherInFrame, surroundingsOf } from '../results/surroundings';
import { texts } from '../texts/texts';
import { flat } from './pixels';
import { type ComponentName, otherThan } from '../terms/component';

/** A click inside the implant, or opposite corners of a rough box. */
export type Prompt = readonly [FramePoint] | readonly [FramePoint, FramePoint];

/** What was asked of a cell and is not answered yet. */
interface Asked {
  readonly prompt: Prompt;
  readonly place: Place;
  readonly frame: FrameEntry;
  readonly bright: boolean | null;
  /** One that was found before. */
  readonly pose: PoseNumbers | null;
  readonly abort: AbortController;
}

/** Asks the pose worker for first outlines and poses, in the order of the clicks; a newer click into the same cell calls the older one off. */
export class OneClick {
  readonly #services: Services;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  readonly #asked = new Map<string, Asked>();
  readonly #film: { ready(): Promise<void> };
  #turn: Promise<void> = Promise.resolve();
  /** The checked cell into which the last click went. */
  #warned: string | null = null;

  constructor(services: Services, worker: Pick<Bridge<PoseProtocol>, 'call'>, film: { ready(): Promise<void> }) {
    this.#services = services;
    this.#worker = worker;
    this.#film = film;
  }

  async ask(prompt: Prompt, place: Place, bright: boolean | null, pose: PoseNumbers | null = null): Promise<void> {
    const { store } = this.#services;
    const frame = store.doc.frames.find(({ id }) => id === place.frameId);
    if (!frame) return;
    const key = cellKey(place.frameId, place.component);
    if (this.#isGuarded(key, place)) return store.say('info', texts.tracing.said.isChecked(texts.component[place.component]));
    this.#asked.get(key)?.abort.abort();
    const asked = { prompt, place, frame, bright, pose, abort: new AbortController() };
    this.#asked.set(key, asked);
    const before = this.#turn;
    const answered = this.#answer(asked, before).catch((error: unknown) => {
      if (!(error instanceof Aborted)) store.sayAt(place, 'error', this.#withUnit(place.component, sentenceOf(error)));
    });
    this.#turn = Promise.all([before, answered]).then(() => undefined);
    await answered;
    if (this.#asked.get(key) === asked) this.#asked.delete(key);
  }

  /** Whether a click would take the place of what a person has checked: it does from the second on. */
  #isGuarded(key: string, place: Place): boolean {
    const { doc } = this.#services.store;
    const isFirst = this.#warned !== key;
    const isGuarded = isFirst && checkState(cellOf(doc, place.frameId, place.component), markOf(doc, place)) === 'yes';
    this.#warned = isGuarded ? key : null;
    return isGuarded;
  }

  /** Its job is shown from the click on; what it knows of the film it looks up when its turn comes. */
  async #answer(asked: Asked, before: Promise<void>): Promise<void> {
    const { place, abort, prompt } = asked;
    const { store } = this.#services;
    const number = 1 + store.doc.frames.findIndex(({ id }) => id === place.frameId);
    const title = texts.tracing.said.oneClickJob(texts.componentTitle[place.component], number);
    const job = { title, unit: texts.tracing.said.percent, total: 0, cancel: () => abort.abort(), place, at: prompt[0] };
    await asJob(store, job, async (report) => {
      // Without the library that is being built there would be an outline and no pose.
      await unlessAborted(Promise.all([before, libraryReady(store, place.component)]), abort.signal);
      // What the clicks before tell of the film tells a tray's outer rim from its inner one. While it is followed it is told.
      const isTold = store.ui.following && filmNumbers(store.doc, place.component) !== null;
      if (!isTold) await unlessAborted(this.#film.ready(), abort.signal);
      await this.#find(asked, report);
    });
  }

  async #find({ prompt, place, frame, bright, pose, abort }: Asked, report: (done: number, total: number) => void): Promise<void> {
    const { store } = this.#services;
    const { component } = place;
    const pixels = await this.#services.studio.framePixels(frame.id);
    const input = { ...this.#input(prompt, place, frame, bright, pixels), pose };
    const before = cellOf(store.doc, frame.id, component);
    const key = input.withModel ? poseKey(store.doc, component, frame) : null;
    const answer = await this.#worker.call('oneClick', input, {
      signal: abort.signal,
      transfer: [input.frame.pixels.buffer],
      onProgress: ({ fraction }) => report(Math.round(100 * fraction), 100),
    });
    // It would come into the work that was begun meanwhile.
    if (indexOfFrame(store.doc, frame.id) < 0) return;
    const now = cellOf(store.doc, frame.id, component);
    const isSetSince = isByHand(now.result) && chosenCandidate(now)?.pose !== chosenCandidate(before)?.pose;
    if (isSetSince || now.outline !== before.outline) return store.sayAt(place, 'info', texts.tracing.said.changedMeanwhile);
    // What a good click tells of the film holds for the next, and for the other tools.
    if (store.ui.tracing.bright === null && answer.match?.verdict?.word === 'good') store.setTracing({ bright: answer.bright });
    // What was found before nobody pointed at.
    this.#take(answer, { place, clickedAt: prompt.length === 1 && pose === null ? prompt[0] : null }, key, input.film);
  }

  #input(prompt: Prompt, { component }: Place, frame: FrameEntry, bright: boolean | null, pixels: FramePixels | null): Omit<OneClickInput, 'pose'> {
    const { store } = this.#services;
    const camera = cameraOf(store.doc, frame);
    if (!camera) throw new Error(texts.tracing.said.needsCalibration);
    if (!pixels) throw new Error(texts.tracing.said.noPixels(frame.name));
    if (camera.distortion) throw new Error(texts.calibrate.distortedFrame);
    const { outline } = cellOf(store.doc, frame.id, otherThan(component));
    const isOpen = (name: ComponentName) => store.ui.libraries[name].state === 'ready';
    return {
      component,
      camera,
      frame: pixels,
      prompt: promptNumbers(prompt),
      bright,
      avoid: outline?.closed ? flat(outline.points) : null,
      withModel: isOpen(component),
      other: isOpen(otherThan(component)) ? otherInFrame(store.doc, frame.id, component) : null,
      around: surroundingsOf(store.doc, frame.id, component),
      film: filmNumbers(store.doc, component),
      misfits: misfitsBeside(store.doc, { frameId: frame.id, component }),
    };
  }

  /** What failed, and first the question of the model's unit where nobody has answered it: a knee of a metre or a micrometre is found nowhere. */
  #withUnit(component: ComponentName, sentence: string): string {
    const { studio, store } = this.#services;
    const { model } = store.doc.components[component];
    const isAsked = model !== null && studio.suspectedUnitsOf(model.sha256).length > 0;
    return isAsked ? texts.tracing.said.unitFirst(texts.component[component], model.name, sentence) : sentence;
  }

  #take(answer: OneClickFacts, { place, clickedAt }: { readonly place: Place; readonly clickedAt: FramePoint | null }, key: string | null, film: OneClickInput['film']): void {
    const { store } = this.#services;
    const laidBy = answer.match ? 'click' : 'tool';
    const outlines = answer.outlines.map((numbers) => ({ points: pointsFrom(numbers), closed: true, unknownSides: [], laidBy }) as const);
    const onFrame = { film: (answer.corrected && film?.slice(0, CONSTANTS)) || null, ...(clickedAt && { clickedAt }) };
    const before = store.doc;
    const sentence = answer.match?.refusal == null ? answer.sentence : this.#withUnit(place.component, answer.sentence);
    store.perform(oneClickOutline(place, outlines, { ...answer, sentence, onFrame }, key));
    store.show({ selectedPoint: null });
    const followed = gaveWay(before, store.doc, place) ? ` ${texts.follow.gaveWay}` : '';
    // What was refused stands in the cell and the bottom line as long as it does.
    if (answer.match?.refusal != null) return;
    store.say('info', (verdictSentence(place.component, answer) ?? answer.sentence) + followed, undefined, 'pose');
    quietOnceOther(store, place);
  }
}

/** What was just said of a pose is not left beside another verdict: what comes to be known of film and joint may decide between two poses. */
function quietOnceOther(store: Store, { frameId, component }: Place): void {
  const { notice } = store.ui;
  const wordNow = () => verdictOf(cellOf(store.doc, frameId, component).result)?.word;
  const said = wordNow();
  const end = store.subscribe(() => {
    const isSaid = store.ui.notice === notice;
    // While it is refined anew there is none.
    if (isSaid && [said, undefined].includes(wordNow())) return;
    end();
    if (isSaid) store.quiet();
  });
}

/** What is said of a pose is its verdict: of one that is good no doubt. Null without one. */
function verdictSentence(component: ComponentName, { match }: OneClickFacts): string | null {
  const { word, because } = match?.verdict ?? {};
  return word && because ? texts.tracing.said.oneClickFound(texts.componentTitle[component], texts.panel.pose.verdicts[word], because) : null;
}

function promptNumbers([a, b]: Prompt): Float64Array<ArrayBuffer> {
  if (!b) return Float64Array.of(a.column, a.row);
  const least = framePoint(Math.min(a.column, b.column), Math.min(a.row, b.row));
  const most = framePoint(Math.max(a.column, b.column), Math.max(a.row, b.row));
  return Float64Array.of(least.column, least.row, most.column, most.row);
}

/** Waits, unless it is called off first. */
function unlessAborted<T>(waited: Promise<T>, signal: AbortSignal): Promise<T> {
  const aborted = new Promise<never>((_, reject) => {
    const give = () => reject(new Aborted());
    if (signal.aborted) give();
    else signal.addEventListener('abort', give, { once: true });
  });
  return Promise.race([waited, aborted]);
}
