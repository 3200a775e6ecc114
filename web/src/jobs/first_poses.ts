import type { Place } from '../document/command';
import { setOutline } from '../document/outlines';
import { type Cell, cellOf, chosenCandidate, type FrameEntry } from '../document/types';
import { middleOf } from '../geometry/mesh_middle';
import { type FramePoint, framePoint } from '../geometry/points';
import { inCamera } from '../geometry/pose_motion';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { cameraOf } from '../results/keys';
import { COMPONENT_NAMES, type ComponentName, otherThan } from '../terms/component';
import { texts } from '../texts/texts';
import type { Bridge } from '../workers/bridge';
import type { Clicked, ClickOutcome, Discovery, FindInput, Known, Member, PlanState, PlanStep, WalkInput } from '../workers/protocol/first_poses';
import type { FollowProtocol } from '../workers/protocol/follow';
import { frameAt } from './beside_poses';
import { libraryReady } from './library_ready';
import { type CalledOff, type Distance, SearchLibraries } from './search_libraries';
import { asJob, type Services } from './services';

type Worker = Pick<Bridge<FollowProtocol>, 'call'>;
export type Workers = Readonly<Record<ComponentName, Worker>>;

/** So many frames in which a component is known lead to one that is missing, as the core has it. */
const LED = 3;

/** What a click would do, or a pose that was found there. */
export interface Clicks {
  ask(prompt: readonly [FramePoint], place: Place, bright: boolean | null, pose: PoseNumbers | null): Promise<void>;
}

/** What is known before components are looked for. */
export interface Beforehand {
  /** Cells that tell nothing, though they have poses. */
  readonly without: ReadonlySet<Cell>;
  /** Metal is bright; null where that is not known. */
  readonly isBright: boolean | null;
}

const NOTHING: Beforehand = { without: new Set(), isBright: null };

/** A component that was found: by which way of showing metal, and where. */
interface Taken {
  readonly way: number;
  readonly place: Place;
  readonly done: Promise<void>;
}

/** What a search goes by. */
interface Search extends CalledOff {
  /** The film as it was at the beginning: others may come between its frames. */
  readonly frames: readonly FrameEntry[];
  readonly parts: readonly Member[];
  readonly workers: Workers;
  readonly bright: boolean | null;
  /** Places in what was found, by way, component and frame. */
  readonly places: Map<string, readonly [number, number]>;
  readonly taken: Map<ComponentName, Taken>;
  /** Of each component the libraries that its worker has, as they are numbered there. */
  readonly opened: Map<ComponentName, Distance[]>;
}

/**
 * Finds components that nobody pointed at, in the order of work that the core has for the page and the commands: which is looked for next,
 * in which frame and how. Each worker searches for its component; what is found is judged and corrected as what a click leads to.
 */
export class FirstPoses {
  readonly #services: Services;
  readonly #clicks: Clicks;
  readonly #libraries: Pick<SearchLibraries, 'distances' | 'bytes'>;

  constructor(services: Services, clicks: Clicks, libraries: Pick<SearchLibraries, 'distances' | 'bytes'>) {
    this.#services = services;
    this.#clicks = clicks;
    this.#libraries = libraries;
  }

  /** Opens what frames are searched with where a component is lost that was at a pose; false where there is no library. */
  async open(component: ComponentName, worker: Worker, pose: PoseNumbers | null, calledOff: CalledOff): Promise<boolean> {
    const own = this.#member(component);
    const depth = own && pose && -inCamera(pose, middleOf(own.mesh))[2];
    const [distance = null] = await this.#libraries.distances(component, worker, depth);
    return this.#openAt(component, worker, distance, calledOff);
  }

  async #openAt(component: ComponentName, worker: Worker, distance: Distance, calledOff: CalledOff): Promise<boolean> {
    const { store, studio } = this.#services;
    await libraryReady(store, component);
    const { doc, ui } = store;
    const own = this.#member(component);
    const camera = cameraOf(doc, doc.frames[0] ?? null);
    if (!own || !camera || ui.libraries[component].state !== 'ready') return false;
    const library = await this.#libraries.bytes(component, distance, calledOff);
    const other = studio.meshOf(doc.components[otherThan(component)].model?.sha256 ?? '') && this.#member(otherThan(component));
    await worker.call('openSearch', { ...own, other, camera, library, bright: ui.tracing.bright ?? false }, { transfer: [library.buffer] });
    return true;
  }

  /**
   * Looks for components; gives the places where they were found. Poses `without` which they are looked for tell nothing; how the film shows
   * metal may be known all the same.
   */
  async find(wanted: readonly ComponentName[], workers: Workers, calledOff: CalledOff, { without, isBright: told }: Beforehand = NOTHING): Promise<readonly Place[]> {
    const parts = COMPONENT_NAMES.flatMap((name) => this.#member(name) ?? []);
    const { frames } = this.#services.store.doc;
    const search = { ...calledOff, frames, parts, workers, places: new Map(), taken: new Map(), opened: new Map<ComponentName, Distance[]>() };
    const known = new Map(parts.map(({ component }) => [component, wanted.includes(component) ? [] : this.#known(component, without)]));
    const bright = this.#services.store.ui.tracing.bright ?? told ?? (await this.#told({ ...search, bright: null }, known));
    await this.#run({ ...search, bright }, known);
    await Promise.all([...search.taken.values()].map(({ done }: Taken) => done));
    return [...search.taken.values()].map(({ place }: Taken) => place).filter((place) => this.#isPosed(place));
  }

  /** What a click leads to with what is known of the other component by now. */
  async clickAgain(place: Place, [column, row]: Clicked['place']): Promise<void> {
    await this.#clicks.ask([framePoint(column, row)], place, this.#services.store.ui.tracing.bright, null);
  }

  /** Follows a component to the frame of a click and compares both there. */
  async compare(component: ComponentName, worker: Worker, known: Known, click: Clicked, bright: boolean, calledOff: CalledOff): Promise<ClickOutcome> {
    const { frames } = this.#services.store.doc;
    await this.#walked(component, worker, { ...known, frames: frames.length, bright, goal: click.frame }, { frames, ...calledOff });
    const { frameId: _, ...pixels } = await frameAt(this.#services, frames, click.frame);
    return worker.call('clickOutcome', { ...pixels, ...click }, { transfer: [pixels.pixels.buffer] });
  }

  async #run(search: Search, known: ReadonlyMap<ComponentName, readonly Known[]>): Promise<PlanState> {
    const { store } = this.#services;
    // Any worker has the order of all.
    const planner = search.workers.femur;
    const parts = search.parts.map((part) => ({ ...part, known: known.get(part.component) ?? [] }));
    let state = await planner.call('plan', { frames: search.frames.length, told: search.bright !== null, parts });
    for (let { step } = state; step !== null; { step } = state) {
      const answer = step.search === 'follow' ? { ends: await this.#walk(step, search) } : { found: await this.#look(step, search) };
      state = await planner.call('planned', answer);
      this.#take(step.way, state, search);
    }
    // Another way may count in the end.
    for (const [component, { way, place, done }] of search.taken) {
      if (way === state.way) continue;
      await done;
      store.perform(setOutline(place, texts.steps.oneClick, null));
      search.taken.delete(component);
    }
    if (state.way !== null) this.#take(state.way, state, search);
    return state;
  }

  /** Sets what was found by now, as a click would. */
  #take(way: number, { known }: PlanState, search: Search): void {
    search.parts.forEach(({ component }, part) => {
      const one = known[way]?.[part];
      const at = one && search.places.get(`${way} ${part} ${one.frame}`);
      const frame = one && search.frames[one.frame];
      if (!at || !frame || search.taken.has(component)) return;
      const place = { frameId: frame.id, component };
      const done = this.#clicks.ask([framePoint(...at)], place, isBright(way, search), one.pose);
      search.taken.set(component, { way, place, done });
    });
  }

  /** Compares a frame with one library after the other until the component is found. */
  async #look(step: PlanStep, search: Search): Promise<Discovery | null> {
    const { component } = search.parts[step.part]!;
    // Where its joint leaves it no views are asked: what is open will do.
    const isOfJoint = step.search === 'joint';
    const opened = isOfJoint && search.opened.get(component);
    const distances = opened || (await this.#libraries.distances(component, search.workers[component], step.depth));
    for (const distance of isOfJoint ? distances.slice(0, 1) : distances) {
      const library = await this.#numberOf(distance, component, search);
      const found = library === null ? null : await this.#compare(step, library, search);
      if (found) return found;
    }
    return null;
  }

  async #compare({ way, part, frame, search: how, places, known }: PlanStep, library: number, search: Search): Promise<Discovery | null> {
    const own = search.parts[part]!;
    const { component } = own;
    const worker = search.workers[component];
    const { frameId, ...pixels } = await frameAt(this.#services, search.frames, frame);
    const beside: FindInput['beside'] = known && { pose: known, inJoint: how === 'joint' };
    const other = known && texts.component[otherThan(component)];
    const title = texts.follow.looking(texts.component[component], frame + 1, other);
    const job = { title, unit: texts.tracing.said.percent, total: 100, cancel: search.cancel, place: { frameId, component } };
    const found = await asJob(this.#services.store, job, (report) =>
      worker.call('find', { ...pixels, library, beside, places, bright: isBright(way, search) }, {
        signal: search.signal,
        transfer: [pixels.pixels.buffer],
        onProgress: ({ fraction }) => report(Math.round(100 * fraction), 100),
      }),
    );
    if (found) search.places.set(`${way} ${part} ${frame}`, found.place);
    return found;
  }

  /** Follows a component to both sides of a frame in which it is known: where the other one is looked for too. */
  async #walk({ way, part, frame, known }: PlanStep, search: Search): Promise<Float64Array<ArrayBuffer>> {
    const { component } = search.parts[part]!;
    if (known === null || !(await this.#isOpen(component, search))) return new Float64Array();
    const begun = { frame, pose: known, frames: search.frames.length, bright: isBright(way, search), goal: null };
    return this.#walked(component, search.workers[component], begun, search);
  }

  async #walked(component: ComponentName, worker: Worker, begun: WalkInput, { frames, signal, cancel }: CalledOff & Pick<Search, 'frames'>): Promise<Float64Array<ArrayBuffer>> {
    let ends = new Float64Array();
    const title = texts.follow.looking(texts.component[component], begun.frame + 1, null);
    await asJob(this.#services.store, { title, unit: '', total: 0, cancel }, async () => {
      for (let next = await worker.call('beginWalk', begun); next !== null; ) {
        const { frameId: _, ...pixels } = await frameAt(this.#services, frames, next);
        ({ next, ends } = await worker.call('walk', pixels, { signal, transfer: [pixels.pixels.buffer] }));
      }
    });
    return ends;
  }

  async #isOpen(component: ComponentName, search: Search): Promise<boolean> {
    if (search.opened.has(component)) return true;
    const [first = null] = await this.#libraries.distances(component, search.workers[component], null);
    return (await this.#numberOf(first, component, search)) !== null;
  }

  /** The number of a library in the worker, which is given it where it has it not yet; null where there is none. */
  async #numberOf(distance: Distance, component: ComponentName, search: Search): Promise<number | null> {
    const worker = search.workers[component];
    const opened = search.opened.get(component);
    if (!opened) {
      if (!(await this.#openAt(component, worker, distance, search))) return null;
      search.opened.set(component, [distance]);
      return 0;
    }
    const number = opened.indexOf(distance);
    if (number >= 0) return number;
    const library = await this.#libraries.bytes(component, distance, search);
    await worker.call('addLibrary', { library }, { transfer: [library.buffer] });
    return opened.push(distance) - 1;
  }

  /** Whether metal is bright, by a component that is known; null where none is. */
  async #told(search: Search, known: ReadonlyMap<ComponentName, readonly Known[]>): Promise<boolean | null> {
    for (const [component, [first]] of known) {
      if (!first || !(await this.#isOpen(component, search))) continue;
      const { frameId: _, ...pixels } = await frameAt(this.#services, search.frames, first.frame);
      return search.workers[component].call('isBright', { ...pixels, pose: first.pose }, { transfer: [pixels.pixels.buffer] });
    }
    return null;
  }

  /** Frames in which a component has a pose. */
  #known(component: ComponentName, without: Beforehand['without']): readonly Known[] {
    const { doc } = this.#services.store;
    const all = doc.frames.flatMap(({ id }, frame) => {
      const cell = cellOf(doc, id, component);
      const pose = chosenCandidate(cell)?.pose;
      return pose && !without.has(cell) ? [{ frame, pose }] : [];
    });
    return all.slice(0, LED);
  }

  #member(component: ComponentName): Member | null {
    const { store, studio } = this.#services;
    const { model, axes } = store.doc.components[component];
    const mesh = studio.meshOf(model?.sha256 ?? '');
    return mesh && { component, mesh, axes };
  }

  #isPosed(place: Place): boolean {
    return cellOf(this.#services.store.doc, place.frameId, place.component).result?.kind === 'posed';
  }
}

function isBright(way: number, { bright }: Pick<Search, 'bright'>): boolean {
  return bright ?? way === 1;
}
