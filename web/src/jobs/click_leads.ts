import type { Place } from '../document/command';
import { withCell } from '../document/commands';
import { setOutline } from '../document/outlines';
import { type Cell, cellKey, cellOf, chosenCandidate, type FrameEntry } from '../document/types';
import { type Given, spanToFollow } from '../results/spans';
import { standingOf } from '../results/steps';
import { COMPONENT_NAMES, type ComponentName, otherThan } from '../terms/component';
import { texts } from '../texts/texts';
import type { Clicked, ClickOutcome } from '../workers/protocol/first_poses';
import { frameAt } from './beside_poses';
import type { FirstPoses, Workers } from './first_poses';
import type { CalledOff } from './search_libraries';
import { asJob, type Services } from './services';

type First = Pick<FirstPoses, 'open' | 'find' | 'compare' | 'clickAgain'>;

/** A click whose pose is doubtful. */
interface Click extends Clicked {
  readonly component: ComponentName;
  readonly cell: Cell;
}

/** One whose pose does not convince: it is held back until it is known what the film finds without it. */
interface HeldBack extends Click {
  readonly score: number;
  readonly bright: boolean;
}

/** What is known before a film is followed. */
export interface Begun {
  /** Components that are nowhere. */
  readonly missing: readonly ComponentName[];
  /** Sentences about clicks that do not lead. */
  readonly told: readonly string[];
}

/**
 * The poses that a film is followed from: those that are set, what is found of components that are set nowhere, and of clicks whose poses do
 * not convince those that the film does not outdo. A wrong pose in one frame is followed into all others.
 */
export class ClickLeads {
  readonly #services: Services;
  readonly #first: First;
  /** Clicks that were compared, and lead. */
  readonly #settled = new Set<string>();

  constructor(services: Services, first: First) {
    this.#services = services;
    this.#first = first;
  }

  async begin(present: readonly ComponentName[], workers: Workers, calledOff: CalledOff): Promise<Begun> {
    const run = new Run(this.#services, this.#first, this.#settled, workers, calledOff);
    const told = await run.leads(present);
    return { missing: run.unposed(present), told };
  }
}

/** One time that it is asked. */
class Run {
  readonly #services: Services;
  readonly #first: First;
  readonly #settled: Set<string>;
  readonly #workers: Workers;
  readonly #calledOff: CalledOff;
  #held: readonly HeldBack[] = [];
  /** How the film shows metal, as the clicks tell it. */
  #isBright: boolean | null = null;

  constructor(services: Services, first: First, settled: Set<string>, workers: Workers, calledOff: CalledOff) {
    this.#services = services;
    this.#first = first;
    this.#settled = settled;
    this.#workers = workers;
    this.#calledOff = calledOff;
  }

  unposed(present: readonly ComponentName[]): readonly ComponentName[] {
    return standingOf(this.#services.store.doc).unposed.filter((component) => present.includes(component));
  }

  /** Finds what leads; gives what is to be told. */
  async leads(present: readonly ComponentName[]): Promise<readonly string[]> {
    await this.#holdBack(present);
    const alone = present.filter((component) => this.#held.some((one) => one.component === component) && this.#known(component).length === 0);
    const found = await this.#find([...this.unposed(present), ...alone]);
    const told: string[] = [];
    let isNew = false;
    for (const one of this.#held.toSorted((a, b) => b.score - a.score)) {
      if (this.#calledOff.signal.aborted) return told;
      const lead = this.#nearest(one);
      const outcome = lead ? await this.#compared(one, lead) : 'leads';
      isNew ||= outcome === 'leads' && alone.includes(one.component);
      this.#held = this.#held.filter((other) => other !== one);
      if (outcome === 'leads') this.#lead(one, found);
      else this.#giveWay(one);
      if (outcome === 'outdone' && lead) told.push(texts.follow.outdone(texts.component[one.component], one.frame + 1, lead.frame + 1));
    }
    // What a click leads to after all leads to others.
    if (isNew) await this.#find(this.unposed(present));
    return told;
  }

  async #find(wanted: readonly ComponentName[]): Promise<readonly Place[]> {
    if (wanted.length === 0) return [];
    return this.#first.find(wanted, this.#workers, this.#calledOff, { without: this.#cells(), isBright: this.#isBright });
  }

  /** Holds back clicks that a film would be followed from, whose poses are doubtful and lie on weak edges, beside what else is known too. */
  async #holdBack(present: readonly ComponentName[]): Promise<void> {
    for (const component of COMPONENT_NAMES.filter((name) => present.includes(name))) {
      const clicks = this.#doubtful(component);
      if (clicks.length === 0 || !(await this.#first.open(component, this.#workers[component], clicks[0]!.pose, this.#calledOff))) continue;
      for (const click of clicks) await this.#holdIfWeak(click);
    }
    for (const one of this.#held) await this.#again(one);
  }

  #doubtful(component: ComponentName): readonly Click[] {
    const { doc } = this.#services.store;
    const given = spanToFollow(doc, component)?.given ?? [];
    const clicks = given.filter(({ isDoubtful, isSet }) => isDoubtful && !isSet).flatMap(({ frame }) => clickOf(cellOf(doc, doc.frames[frame]!.id, component), component, frame) ?? []);
    return clicks.filter((click) => !this.#settled.has(keyOf(doc.frames, click)));
  }

  async #holdIfWeak(click: Click): Promise<void> {
    const one = await this.#judged(click);
    if (one) this.#held = [...this.#held, one];
  }

  /** The same clicked once more beside the other component, where that is known in its frame: the better of both stays. */
  async #again(one: HeldBack): Promise<void> {
    const { store } = this.#services;
    const place = placeOf(store.doc.frames, one);
    const isKnown = this.#known(otherThan(one.component)).some(({ frame }) => frame === one.frame);
    if (!isKnown || this.#calledOff.signal.aborted) return;
    await this.#first.clickAgain(place, one.place);
    const click = clickOf(cellOf(store.doc, place.frameId, one.component), one.component, one.frame);
    const again = click && (await this.#judged(click));
    if (click && !again) this.#held = this.#held.filter((other) => other !== one);
    else if (again && again.score > one.score) this.#held = this.#held.map((other) => (other === one ? again : other));
    else this.#restore(one);
  }

  /** Null where it convinces. */
  async #judged(click: Click): Promise<HeldBack | null> {
    const { store } = this.#services;
    const { component, frame, pose, place } = click;
    const { signal, cancel } = this.#calledOff;
    const worker = this.#workers[component];
    const pixels = async () => {
      const { frameId: _, ...pixels } = await frameAt(this.#services, store.doc.frames, frame);
      return { pixels, options: { signal, transfer: [pixels.pixels.buffer] } };
    };
    const title = texts.follow.looking(texts.component[component], frame + 1, null);
    return asJob(store, { title, unit: '', total: 0, cancel }, async () => {
      const near = await pixels();
      const bright = store.ui.tracing.bright ?? (await worker.call('isBrightNear', { ...near.pixels, place }, near.options));
      const there = await pixels();
      const { score, convinces } = await worker.call('clickStands', { ...there.pixels, pose, bright }, there.options);
      this.#isBright ??= bright;
      return convinces ? null : { ...click, score, bright };
    });
  }

  #compared(one: HeldBack, lead: Given): Promise<ClickOutcome> {
    return this.#first.compare(one.component, this.#workers[one.component], lead, one, one.bright, this.#calledOff);
  }

  /** Cells of what is held back, as they are now: what comes to be known of the film moves their poses. */
  #cells(): ReadonlySet<Cell> {
    return new Set(this.#held.flatMap((one) => this.#standing(one) ?? []));
  }

  /** The cell of a click; null where something else is there by now. */
  #standing(one: HeldBack): Cell | null {
    const { frameId, component } = placeOf(this.#services.store.doc.frames, one);
    const cell = cellOf(this.#services.store.doc, frameId, component);
    const now = clickOf(cell, component, one.frame);
    return now?.place.join() === one.place.join() ? cell : null;
  }

  /** Frames that a component would be followed from but for what is held back. */
  #known(component: ComponentName): readonly Given[] {
    const { doc } = this.#services.store;
    const cells = this.#cells();
    const given = spanToFollow(doc, component)?.given ?? [];
    return given.filter(({ frame }) => !cells.has(cellOf(doc, doc.frames[frame]!.id, component)));
  }

  #nearest({ component, frame }: HeldBack): Given | null {
    const away = (one: Given) => Math.abs(one.frame - frame);
    return this.#known(component).toSorted((a, b) => away(a) - away(b))[0] ?? null;
  }

  /** A click leads, in the place of what was found without it. */
  #lead(one: HeldBack, found: readonly Place[]): void {
    const { store } = this.#services;
    for (const place of found.filter(({ component }) => component === one.component)) store.perform(setOutline(place, texts.steps.oneClick, null));
    if (!this.#standing(one)) this.#restore(one);
    this.#settled.add(keyOf(store.doc.frames, one));
  }

  #restore(one: HeldBack): void {
    const { store } = this.#services;
    const place = placeOf(store.doc.frames, one);
    store.perform({ label: texts.steps.oneClick, place, apply: (doc) => withCell(doc, place, one.cell) });
  }

  /** What was found in its own frame is there already. */
  #giveWay(one: HeldBack): void {
    const { store } = this.#services;
    if (this.#standing(one)) store.perform(setOutline(placeOf(store.doc.frames, one), texts.steps.oneClick, null));
  }
}

/** One that is clicked anew is another. */
function keyOf(frames: readonly FrameEntry[], click: Click): string {
  const { frameId, component } = placeOf(frames, click);
  return [cellKey(frameId, component), ...click.place].join();
}

function placeOf(frames: readonly FrameEntry[], { frame, component }: Click): Place {
  return { frameId: frames[frame]!.id, component };
}

/** Null where nobody clicked. */
function clickOf(cell: Cell, component: ComponentName, frame: number): Click | null {
  const at = cell.result?.kind === 'posed' ? cell.result.onFrame?.clickedAt : undefined;
  const pose = chosenCandidate(cell)?.pose;
  return at && pose ? { component, cell, frame, pose, place: [at.column, at.row] } : null;
}
