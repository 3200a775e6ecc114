import type { Place } from '../document/command';
import { filmNumbers } from '../document/film';
import { type Followed, withSoFar } from '../document/followed';
import { type Cell, cellOf, chosenCandidate, type FrameEntry, type Result, verdictOf } from '../document/types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { Span } from '../results/spans';
import { COMPONENT_NAMES, type ComponentName, otherThan } from '../terms/component';
import type { Bridge } from '../workers/bridge';
import type { Femurs, FollowedFrame, FollowProtocol } from '../workers/protocol/follow';
import { frameAt, subjectOf, unlessAborted } from './beside_poses';
import type { FirstPoses } from './first_poses';
import type { Looked, Progress } from './follow_progress';
import type { CalledOff } from './search_libraries';
import type { Services } from './services';

/** What was there in cells that are followed so far, by component and frame. */
export type Before = Map<string, readonly [Place, Cell]>;

/** A component with the frames that it is followed over. */
export interface Part {
  readonly component: ComponentName;
  readonly worker: Pick<Bridge<FollowProtocol>, 'call'>;
  readonly span: Span;
  /** The film as it was when the span was told: its numbers of frames count in it. */
  readonly frames: readonly FrameEntry[];
}

/** How the work came to its end: what was not reached is as it was, and what another pass was to take the place of is to be followed again. */
export type Ending = 'done' | 'stopped' | 'superseded';

type Middles = Float64Array<ArrayBuffer>;

const NO_MIDDLES = new Float64Array();
/** No end of what a frame is followed from: what bears it is followed again. */
const SUPERSEDED = ', before the film was known better';

/** All components followed through the film once, with what is known of the film by then; each in its worker. */
export class FilmPass {
  readonly #services: Services;
  readonly #first: Pick<FirstPoses, 'open'>;
  readonly #parts: readonly Part[];
  readonly #before: Before;
  readonly #progress: Progress;
  readonly #signal: AbortSignal;
  readonly #calledOff: CalledOff;

  constructor(services: Services, first: Pick<FirstPoses, 'open'>, parts: readonly Part[], before: Before, progress: Progress, calledOff: CalledOff) {
    this.#services = services;
    this.#first = first;
    this.#parts = parts;
    this.#before = before;
    this.#progress = progress;
    this.#signal = calledOff.signal;
    this.#calledOff = calledOff;
  }

  /** Follows them, and looks for what is lost. */
  async run(): Promise<void> {
    await this.#bothSides();
    await this.#findLost();
    if (this.#signal.aborted) await Promise.all(this.#parts.map(({ worker }) => worker.call('stop', null)));
  }

  /** What became of every frame, doubtful ones with what they look like from the other side of the mirror. */
  async answers(): Promise<readonly Followed[]> {
    const film = await this.#concluded((part, middles) => this.#compared(part, middles));
    const ending = this.#signal.aborted ? 'stopped' : 'done';
    return this.#parts.flatMap((part, at) => this.#answersOf(part, film[at]!, ending));
  }

  /** The same for the case that another pass, which is to take the place of this one, is stopped. */
  async answersSoFar(): Promise<readonly Followed[]> {
    const film = await this.#concluded(({ worker }, otherMiddles) => worker.call('conclude', { otherMiddles }));
    return this.#parts.flatMap((part, at) => this.#answersOf(part, film[at]!, 'superseded'));
  }

  /** Where the other component is in each frame, where that is followed: three numbers each. */
  async otherMiddles(component: ComponentName): Promise<Middles> {
    return (await this.#partOf(otherThan(component))?.worker.call('middles', null)) ?? NO_MIDDLES;
  }

  #partOf(name: ComponentName): Part | undefined {
    return this.#parts.find(({ component }) => component === name);
  }

  async #concluded(answer: (part: Part, otherMiddles: Middles) => Promise<readonly FollowedFrame[]>): Promise<readonly (readonly FollowedFrame[])[]> {
    const middles: Middles[] = [];
    for (const { component } of this.#parts) middles.push(await this.otherMiddles(component));
    return Promise.all(this.#parts.map((part, at) => answer(part, middles[at]!)));
  }

  /**
   * Both components at once: the tibia's sides are chosen with the femur as it was followed, which hardly ever goes over to its other side
   * afterwards. Where it does, and that tells another side of the tibia, this is done again.
   */
  async #bothSides(): Promise<void> {
    const [femur, tibia] = COMPONENT_NAMES.map((name) => this.#partOf(name));
    const isFemurFollowed = femur ? this.#through(femur) : Promise.resolve();
    const early = isFemurFollowed.then(() => this.#femurs());
    const femurDone = early.then(() => femur && this.#sides(femur, null));
    const tibiaDone = tibia && this.#through(tibia).then(async () => this.#sides(tibia, this.#known(await early)));
    await Promise.all([femurDone, tibiaDone]);
    if (!femur || !tibia || this.#signal.aborted) return;
    const femurs = this.#known(await this.#femurs());
    await this.#look(tibia, await tibia.worker.call('standsWith', { femurs }), this.#progress.another);
  }

  /** A component that is lost after all, or lies on other edges, is looked for beside the other one, where that is good. */
  async #findLost(): Promise<void> {
    for (const part of this.#parts) {
      if (this.#signal.aborted) return;
      const { component, worker } = part;
      const other = await this.#good(otherThan(component));
      const femurs = component === 'tibia' ? this.#known(await this.#femurs()) : null;
      const otherMiddles = await this.otherMiddles(component);
      await this.#look(part, await worker.call('lookBeside', { other, otherMiddles, femurs }), this.#progress.another);
    }
  }

  /** The answer, doubtful frames with what they look like from the other side of the mirror. */
  async #compared(part: Part, otherMiddles: Middles): Promise<readonly FollowedFrame[]> {
    const film = await part.worker.call('conclude', { otherMiddles });
    const frames = film.flatMap(({ state }, frame) => (state === 'doubtful' ? [frame] : []));
    if (frames.length === 0 || this.#signal.aborted) return film;
    await this.#look(part, await part.worker.call('compare', { frames }), this.#progress.another);
    return part.worker.call('conclude', { otherMiddles });
  }

  /** From the frames that are set over all others. */
  async #through(part: Part): Promise<void> {
    const { component, worker, span, frames } = part;
    const { doc } = this.#services.store;
    const { mesh, camera } = subjectOf(this.#services, component);
    const { first, last, given } = span;
    const searches = (await this.#first.open(component, worker, given[0]?.pose ?? null, this.#calledOff).catch(unlessAborted)) ?? false;
    const begin = { mesh, camera, frames: frames.length, first, last, given, searches, film: filmNumbers(doc, component) };
    await this.#look(part, await worker.call('begin', begin), this.#progress.followed);
    // Which side is the right one may depend on the femur; what a frame says of both does not, and is looked at meanwhile.
    if (!this.#signal.aborted) await this.#look(part, await worker.call('seeSides', null), this.#progress.another);
  }

  async #sides(part: Part, femurs: Femurs | null): Promise<void> {
    if (!this.#signal.aborted) await this.#look(part, await part.worker.call('sides', { femurs }), this.#progress.another);
  }

  /** Shows the frames that the worker asks for; stops between two of them. What is found fills its cell at once. */
  async #look(part: Part, first: number | null, looked: Looked): Promise<void> {
    const signal = this.#signal;
    for (let next = first; next !== null && !signal.aborted; ) {
      const at = next;
      const { frameId, ...input } = await frameAt(this.#services, part.frames, at);
      const seen = await part.worker.call('look', input, { signal, transfer: [input.pixels.buffer] }).catch(unlessAborted);
      // What was called off for another work is not written into it.
      if (!seen || signal.aborted) return;
      next = seen.next;
      if (seen.pose) this.#fill(part, at, frameId, seen.pose);
      if (seen.isBeside) this.#progress.beside(part.component, at);
      else looked(part.component, at);
    }
  }

  #fill({ component, span }: Part, frame: number, frameId: string, pose: PoseNumbers): void {
    const { store } = this.#services;
    if (span.given.some((one) => one.frame === frame)) return;
    const place = { frameId, component };
    const key = `${component} ${frameId}`;
    if (!this.#before.has(key)) this.#before.set(key, [place, cellOf(store.doc, frameId, component)]);
    store.amend((doc) => withSoFar(doc, place, pose, span.key(frame)));
  }

  /** As far as they are followed; what is not followed is as it is shown. */
  async #femurs(): Promise<readonly (PoseNumbers | null)[]> {
    const shown = this.#shown('femur', () => true);
    const film = await this.#partOf('femur')?.worker.call('conclude', { otherMiddles: NO_MIDDLES });
    return film?.map(({ pose }, frame) => pose ?? shown[frame] ?? null) ?? shown;
  }

  /** The frames in which a component is good, with its poses. */
  async #good(component: ComponentName): Promise<readonly (PoseNumbers | null)[]> {
    const otherMiddles = await this.otherMiddles(component);
    const followed = await this.#partOf(component)?.worker.call('good', { otherMiddles });
    return followed ?? this.#shown(component, (result) => verdictOf(result)?.word === 'good');
  }

  #shown(component: ComponentName, counts: (result: Result | null) => boolean): readonly (PoseNumbers | null)[] {
    const { doc } = this.#services.store;
    const frames = this.#parts[0]?.frames ?? doc.frames;
    return frames.map(({ id }) => {
      const cell = cellOf(doc, id, component);
      return (counts(cell.result) && chosenCandidate(cell)?.pose) || null;
    });
  }

  /** Null where the axes are not known: then edges alone decide. */
  #known(poses: readonly (PoseNumbers | null)[]): Femurs | null {
    const { femur, tibia } = this.#services.store.doc.components;
    const areTold = femur.axes && tibia.axes && femur.axes.told !== 'nothing' && tibia.axes.told !== 'nothing';
    if (!areTold || !femur.axes || !tibia.axes || poses.every((pose) => pose === null)) return null;
    return { poses, axes: femur.axes.directions, own: tibia.axes.directions };
  }

  #answersOf({ component, span, frames }: Part, film: readonly FollowedFrame[], ending: Ending): readonly Followed[] {
    // The film has not told of what leads before it is followed to its end.
    const isDone = ending === 'done';
    const isLeader = (frame: number) => isDone && span.given.some((one) => one.frame === frame && !one.isSet);
    const left = (frame: number) => (isDone ? (film[frame]?.pose ?? null) : null);
    const led = span.isDoubtful || (!isDone && span.given.every(({ isDoubtful }) => isDoubtful));
    const isGiven = (frame: number) => span.given.some((one) => one.frame === frame);
    return film.flatMap((one, index) => {
      const frame = frames[index];
      const isInside = index >= span.first && index <= span.last && (!isGiven(index) || isLeader(index));
      // What was not reached before somebody stopped it is as it was.
      if (!frame || !isInside || (!isDone && one.state === 'unsolved')) return [];
      const place: Place = { frameId: frame.id, component };
      const { pose, deviations, residual, badness, rival, because } = one;
      const doubtful = one.state === 'doubtful';
      const from = ending === 'superseded' ? span.key(index) + SUPERSEDED : span.key(index, left);
      return [{ place, pose, deviations, residual, badness, rival, led, isLeader: isLeader(index), because, doubtful, from }];
    });
  }
}
