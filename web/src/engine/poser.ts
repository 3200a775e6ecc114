import { withCell, type Place } from '../document/commands';
import { currentFrame, currentPlace, type Store } from '../document/store';
import {
  cellOf,
  COMPONENT_NAMES,
  type Candidate,
  type Cell,
  type ComponentName,
  type FrameEntry,
  type Outline,
  type Result,
} from '../document/types';
import { Aborted, type Bridge } from '../worker/bridge';
import { cameraOf, poseKey } from './keys';
import type { Match, Picture, PoseProtocol } from './protocol';
import { sentenceOf } from './services';

interface Task {
  readonly place: Place;
  readonly frame: FrameEntry;
  readonly outline: Outline;
  readonly key: string;
}

/** What a match leaves besides poses: pictures for the panel. Kept as long as its outline is. */
export interface Findings {
  readonly key: string;
  readonly pictures: readonly Picture[];
  readonly canonicalArea: number;
  /** By candidate: the view lies at the library's border. */
  readonly atBorder: readonly boolean[];
  /** The outline's canonical silhouette reaches the border of its frame. */
  readonly clipped: boolean;
  readonly milliseconds: number;
}

/**
 * Keeps every closed outline's pose up to date: whenever the document changes it looks for a cell whose result does
 * not belong to its outline and asks the pose worker, one at a time, what is on view first. While a vertex is dragged
 * only the latest outline is ever asked for; an answer for an outline that is gone is dropped.
 */
export class Poser {
  readonly #store: Store;
  readonly #worker: Bridge<PoseProtocol>;
  readonly #findings = new WeakMap<Outline, Findings>();
  #busy = false;

  constructor(store: Store, worker: Bridge<PoseProtocol>) {
    this.#store = store;
    this.#worker = worker;
    store.subscribe(() => this.#next());
  }

  findings(outline: Outline | null): Findings | null {
    return (outline && this.#findings.get(outline)) ?? null;
  }

  #next(): void {
    if (this.#busy) return;
    const task = this.#find();
    if (task) void this.#run(task);
  }

  #find(): Task | null {
    const { doc, state } = this.#store;
    const shown = currentPlace(state);
    const frame = currentFrame(state);
    const first = shown && frame && this.#task(frame, shown.component, true);
    if (first) return first;
    for (const frame of doc.frames) {
      for (const component of COMPONENT_NAMES) {
        const task = this.#task(frame, component, false);
        if (task) return task;
      }
    }
    return null;
  }

  #task(frame: FrameEntry, component: ComponentName, shown: boolean): Task | null {
    const { doc, ui } = this.#store;
    const cell = cellOf(doc, frame.id, component);
    const { outline } = cell;
    if (!outline?.closed || ui.libraries[component].state !== 'ready') return null;
    const key = poseKey(doc, component, frame);
    if (!key) return null;
    const place = { frameId: frame.id, component };
    const needed = isStale(cell, key) || (shown && !isLoaded(cell) && this.#findings.get(outline)?.key !== key);
    return needed ? { place, frame, outline, key } : null;
  }

  async #run(task: Task): Promise<void> {
    this.#busy = true;
    const { place, frame, outline, key } = task;
    try {
      const camera = cameraOf(this.#store.doc, frame);
      if (!camera) return;
      const { component } = place;
      const match = await this.#worker.call('match', { component, outline: flatten(outline), camera });
      this.#keep(task, match);
      this.#apply(task, posed(match, key));
    } catch (error) {
      if (error instanceof Aborted) return;
      this.#findings.set(outline, { key, pictures: [], canonicalArea: 0, atBorder: [], clipped: false, milliseconds: 0 });
      this.#apply(task, { kind: 'failed', origin: key, sentence: sentenceOf(error) });
    } finally {
      this.#busy = false;
      queueMicrotask(() => this.#next());
    }
  }

  #keep({ outline, key }: Task, match: Match): void {
    const { candidates, canonicalArea, clipped, milliseconds } = match;
    const pictures = candidates.map((candidate) => candidate.picture);
    const atBorder = candidates.map((candidate) => candidate.atBorder);
    this.#findings.set(outline, { key, pictures, canonicalArea, atBorder, clipped, milliseconds });
  }

  /** Takes the result in if it is still wanted: the same outline, the same inputs. */
  #apply({ place, frame, outline, key }: Task, result: Result): void {
    this.#store.amend((doc) => {
      const cell = cellOf(doc, place.frameId, place.component);
      if (cell.outline !== outline || poseKey(doc, place.component, frame) !== key) return doc;
      if (!isStale(cell, key)) return doc;
      return withCell(doc, place, { outline, result: sameChoice(cell.result, result), resultOf: outline });
    });
    // The pictures are no part of the document: the views are told all the same.
    this.#store.show({});
  }
}

/** Does the cell's result still have to be found from its outline? Poses from a file stay until the outline changes. */
function isStale({ outline, result, resultOf }: Cell, key: string): boolean {
  if (!result || resultOf !== outline) return true;
  return !isLoaded({ result }) && result.origin !== key;
}

function isLoaded({ result }: Pick<Cell, 'result'>): boolean {
  return result?.kind === 'posed' && result.from === 'file';
}

/**
 * While an outline is dragged, stay with the candidate that was chosen: the one whose pose is nearest to it, if the
 * person chose the rival before.
 */
function sameChoice(before: Result | null, result: Result): Result {
  if (before?.kind !== 'posed' || result.kind !== 'posed' || before.chosen === 0) return result;
  const previous = before.candidates[before.chosen];
  if (!previous) return result;
  const distances = result.candidates.map((candidate) => turned(previous, candidate));
  return { ...result, chosen: distances.indexOf(Math.min(...distances)) };
}

/** A rough angle between two poses, degrees. */
function turned(a: Candidate, b: Candidate): number {
  return Math.hypot(a.pose.xRot - b.pose.xRot, a.pose.yRot - b.pose.yRot);
}

function posed(match: Match, origin: string): Result {
  const candidates = match.candidates.map(({ pose, unmatched, drawn }) => ({ pose, unmatched, drawn }));
  return { kind: 'posed', from: 'outline', origin, candidates, chosen: 0 };
}

function flatten(outline: Outline): Float64Array<ArrayBuffer> {
  return Float64Array.from(outline.points.flatMap((point) => [point.column, point.row]));
}
