import { filmNumbers } from '../document/film';
import { type Followed, takeFollowed, withoutSoFar } from '../document/followed';
import { anew, foundWith } from '../document/found_anew';
import { currentFrame } from '../document/store';
import { indexOfFrame } from '../document/frame_index';
import { cellOf, chosenCandidate, type Doc, type FrameEntry } from '../document/types';
import { isLed, spanToFollow } from '../results/spans';
import { cameraOf } from '../results/keys';
import { COMPONENT_NAMES, type ComponentName, titleOf } from '../terms/component';
import { texts } from '../texts/texts';
import { Aborted, type Bridge } from '../workers/bridge';
import type { FollowProtocol } from '../workers/protocol/follow';
import { aborted, readAsked, readBeside, readFirst } from './beside_poses';
import type { Beside } from './film_beside';
import type { FilmLater } from './film_later';
import { type Before, FilmPass, type Part } from './film_pass';
import { type Begun, ClickLeads } from './click_leads';
import type { FirstPoses } from './first_poses';
import { Progress } from './follow_progress';
import type { CalledOff } from './search_libraries';
import { asJob, type Report, sentenceOf, type Services } from './services';

type Worker = Pick<Bridge<FollowProtocol>, 'call' | 'dispose'>;

/** What is told beside what following a film came to: of components that were found nowhere it is an error. */
interface Told {
  readonly kind: 'error' | 'info';
  readonly sentences: readonly string[];
}

type Film = Pick<FilmLater, 'ready' | 'chooseSquares' | 'knowsBeside' | 'takeBeside' | 'learnAgain'>;

/**
 * Follows the components through the film from the frames that a person set, in a worker each, while the person goes on working.
 * What a person set never changes, and only what lies between frames that have changed is done again.
 */
export class Follower {
  readonly #services: Services;
  readonly #first: Pick<FirstPoses, 'open'>;
  readonly #leads: ClickLeads;
  readonly #film: Film;
  readonly #workers: Readonly<Record<ComponentName, Worker>>;
  #abort: AbortController | null = null;

  constructor(services: Services, workers: Readonly<Record<ComponentName, Worker>>, first: Pick<FirstPoses, 'open' | 'find' | 'compare' | 'clickAgain'>, film: Film) {
    this.#services = services;
    this.#workers = workers;
    this.#first = first;
    this.#leads = new ClickLeads(services, first);
    this.#film = film;
  }

  /** Begins, or where it is under way stops and keeps what there is. */
  async follow(): Promise<void> {
    if (this.#abort) return this.#abort.abort();
    const { store } = this.#services;
    const refusal = this.#refusal();
    if (refusal !== null) return store.say('info', refusal);
    const abort = (this.#abort = new AbortController());
    const begun = store.doc;
    const unsubscribe = store.subscribe(() => !isOfTheSame(store.doc, begun) && abort.abort());
    store.show({ following: true });
    try {
      const begun = await this.#begin(abort);
      if (!abort.signal.aborted) await this.#readFilm(abort);
      if (!abort.signal.aborted) await this.#follow(begun, abort);
    } catch (error) {
      if (!(error instanceof Aborted)) store.say('error', sentenceOf(error));
    } finally {
      unsubscribe();
      this.#abort = null;
      // What a film needs, some tens of MB, is let go with its workers; the next call starts others.
      for (const component of COMPONENT_NAMES) this.#workers[component].dispose();
      store.show({ following: false });
    }
  }

  /** Finds what is set in no frame, or on weak edges; gives what is nowhere. Waits for what the film tells of itself. */
  async #begin(abort: AbortController): Promise<Begun> {
    const present = this.#present(this.#services.store.doc);
    const begun = await this.#leads.begin(present, this.#workers, { signal: abort.signal, cancel: () => abort.abort() });
    await this.#filmReady(abort);
    return begun;
  }

  /** Reads the film beside the poses that components are followed from all through, so that the way does not depend on a single frame. */
  async #readFilm(abort: AbortController): Promise<void> {
    const { doc } = this.#services.store;
    if (doc.film.stated.constants) return;
    const isToRead = ({ component, span: { free, given, isDoubtful } }: Part) =>
      !isDoubtful && (free + given.length === doc.frames.length || filmNumbers(doc, component) === null);
    const parts = this.#parts(doc).filter(isToRead);
    if ((await this.#lacking(parts)).length === 0) return;
    const side = await this.#film.chooseSquares((tried) => readFirst(this.#services, parts, tried, abort.signal));
    // In other squares than before nothing is read yet.
    const read = await readBeside(this.#services, await this.#lacking(parts), side, abort);
    if (read.size === 0) return;
    for (const [component, beside] of read) await this.#film.takeBeside(component, beside);
    await this.#filmReady(abort);
  }

  /** Those beside whose poses the film was not read. */
  async #lacking(parts: readonly Part[]): Promise<readonly Part[]> {
    const known = await Promise.all(parts.map(({ component }) => this.#film.knowsBeside(component)));
    return parts.filter((_, at) => !known[at]);
  }

  /** When the film has told what it tells, and the poses that lead are corrected by that. */
  #filmReady(abort: AbortController): Promise<void> {
    const job = { title: texts.follow.estimating, unit: '', total: 0, cancel: () => abort.abort() };
    return asJob(this.#services.store, job, () => Promise.race([this.#film.ready(), aborted(abort.signal)]));
  }

  async #follow({ missing, told }: Begun, abort: AbortController): Promise<void> {
    const { store } = this.#services;
    const parts = this.#parts(store.doc);
    const why = missing.map((component) => this.#whyMissing(component));
    const beside = { kind: why.length > 0 ? 'error' : 'info', sentences: [...why, ...told] } as const;
    this.#sayNotFound(missing);
    if (parts.length === 0) return store.say(beside.kind, beside.sentences.join(' ') || this.#nothingToDo());
    const before: Before = new Map();
    const begun = store.doc;
    const cancel = () => abort.abort();
    const job = { title: texts.follow.job, unit: texts.follow.posesUnit, total: framesOf(parts), cancel };
    const found = await asJob(store, job, (report) => this.#all(parts, before, report, { signal: abort.signal, cancel }));
    const isAsBefore = isOfTheSame(store.doc, begun);
    const left = [...before.values()].map(([place, cell]) => [place, isAsBefore ? cell : anew(cell)] as const);
    store.amend((doc) => withoutSoFar(doc, left));
    // Found with a model or a calibration that is another by now, or in another film.
    if (!isAsBefore) return;
    this.#take(parts, found, beside, abort.signal.aborted);
  }

  /** Takes what was found from leads that are still there: who took one back found it wrong. */
  #take(parts: readonly Part[], all: readonly Followed[], beside: Told, isStopped: boolean): void {
    const { store } = this.#services;
    const found = all.filter(({ place }) => isLed(store.doc, place.component));
    if (found.length === 0 && all.length > 0) return store.say('info', this.#nothingToDo());
    if (found.length > 0) store.perform(takeFollowed(found));
    const lacking = found.filter(({ pose }) => !pose).length;
    const done = texts.follow.done(posesOf(store.doc, parts), howManyDoubtful(found), lacking, isStopped);
    store.say(beside.kind, [done, ...beside.sentences].join(' '), undefined, 'film');
  }

  /** In the card of each component, where it was looked for; the bottom line has it with what was found. */
  #sayNotFound(missing: readonly ComponentName[]): void {
    const { store } = this.#services;
    const frame = currentFrame(store.state);
    // What is to be clicked next is the component that a click is for.
    if (missing.length === 1) store.selectComponent(missing[0]!);
    for (const component of frame ? missing : []) {
      store.sayAt({ frameId: frame!.id, component }, 'error', this.#whyMissing(component));
    }
  }

  /** Without a library, as where the calibration is that of other frames, no frame was searched. */
  #whyMissing(component: ComponentName): string {
    const library = this.#services.store.ui.libraries[component];
    if (library.state === 'stopped') return texts.said.library.failed(titleOf(component), library.reason);
    return texts.follow.notFound(texts.component[component]);
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

  #parts(doc: Doc): readonly Part[] {
    return this.#present(doc).flatMap((component) => {
      const span = spanToFollow(doc, component);
      return span ? [{ component, span, frames: doc.frames, worker: this.#workers[component] }] : [];
    });
  }

  /** The components whose models are there. */
  #present(doc: Doc): readonly ComponentName[] {
    const isPresent = (component: ComponentName) => {
      const { model } = doc.components[component];
      return model !== null && this.#services.studio.meshOf(model.sha256) !== null;
    };
    return COMPONENT_NAMES.filter(isPresent);
  }

  /**
   * Follows them, and once more where what is good then tells that the constants of the film are others than those that it was followed with:
   * they hang on the poses that the film was read beside, which may be wrong.
   */
  async #all(parts: readonly Part[], before: Before, report: Report, calledOff: CalledOff): Promise<readonly Followed[]> {
    const { store } = this.#services;
    const { signal } = calledOff;
    const pass = new FilmPass(this.#services, this.#first, parts, before, new Progress(report, framesOf(parts)), calledOff);
    await pass.run();
    const asked = signal.aborted || !this.#isWhole(parts) ? null : await this.#asked(parts, pass, report, signal);
    if (!asked || !(await this.#film.learnAgain(asked, signal))) return pass.answers();
    const soFar = await pass.answersSoFar();
    report(0, 0, { title: texts.follow.estimating, unit: '' });
    await Promise.race([this.#film.ready(), aborted(signal)]);
    // What leads may have been corrected by the film.
    const again = this.#parts(store.doc);
    const progress = new Progress(report, framesOf(again), texts.follow.again);
    const second = new FilmPass(this.#services, this.#first, again, before, progress, calledOff);
    if (!signal.aborted) await second.run();
    return signal.aborted ? soFar : second.answers();
  }

  /** Are all components followed over the whole film? A correction of some frames does not change how others are seen. */
  #isWhole(parts: readonly Part[]): boolean {
    const { doc } = this.#services.store;
    const isWhole = ({ span, frames }: Part) => span.first === 0 && span.last === frames.length - 1;
    return !doc.film.stated.constants && parts.length === this.#present(doc).length && parts.every(isWhole);
  }

  /** What frames say of the film in which all components are good; null where one of them is good in too few. */
  async #asked(parts: readonly Part[], pass: FilmPass, report: Report, signal: AbortSignal): Promise<ReadonlyMap<ComponentName, Beside> | null> {
    report(0, 0, { title: texts.follow.comparing, unit: '' });
    const middles = await Promise.all(parts.map(({ component }) => pass.otherMiddles(component)));
    const each = parts.map(async (part, at) => [part.component, await readAsked(this.#services, part, middles[at]!, signal)] as const);
    const asked = new Map<ComponentName, Beside>();
    for (const [component, read] of await Promise.all(each)) if (read) asked.set(component, read);
    return asked.size === parts.length && !signal.aborted ? asked : null;
  }
}

/** Is all as it was that poses are found with, and the film's frames still among those of the document? */
function isOfTheSame(doc: Doc, begun: Doc): boolean {
  const isThere = doc.frames === begun.frames || begun.frames.every(({ id }) => indexOfFrame(doc, id) >= 0);
  return isThere && foundWith(doc) === foundWith(begun);
}

function framesOf(parts: readonly Part[]): number {
  return parts.reduce((sum, { span }) => sum + span.free + span.given.length, 0);
}

/** How many poses there are of what was followed, those that it was followed from among them. */
function posesOf(doc: Doc, parts: readonly Part[]): number {
  const posed = parts.flatMap(({ component }) => doc.frames.filter(({ id }) => chosenCandidate(cellOf(doc, id, component))));
  return posed.length;
}

function howManyDoubtful(found: readonly Followed[]): 'none' | 'some' | 'all' {
  const posed = found.filter(({ pose }) => pose !== null);
  if (!posed.some(isDoubtful)) return 'none';
  return posed.every(isDoubtful) ? 'all' : 'some';
}

function isDoubtful({ pose, doubtful, led }: Followed): boolean {
  return pose !== null && (doubtful || led);
}
