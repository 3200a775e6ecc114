import { type CellEntry, CellIndex } from '../document/cells';
import { withCell } from '../document/commands';
import type { Place } from '../document/command';
import { inFilmOrder, indexOfFrame } from '../document/frame_index';
import { isOnEdges } from '../document/laid_by';
import { currentCell, currentFrame, currentPlace, type Store } from '../document/store';
import { type Candidate, type Cell, cellOf, type FrameEntry, isByHand, isRefined, type Outline, type Posed, type Result } from '../document/types';
import type { ComponentName } from '../terms/component';
import { Aborted, type Bridge, WorkerStopped } from '../workers/bridge';
import { cameraOf, poseKey, poseKeys } from '../results/keys';
import { PROGRAM } from '../terms/program';
import type { PoseProtocol } from '../workers/protocol/pose';
import type { Match, MatchedCandidate, MatchInput, Refined } from '../workers/protocol/match';
import { isLibraryOpen } from './library_ready';
import { Pause } from './pause';
import { sentenceOf } from './services';
import { surroundingsOf } from '../results/surroundings';
import { texts } from '../texts/texts';

interface Task {
  /** A match gives the library's pose at once; refinement takes longer and makes it better. */
  readonly method: 'match' | 'refine';
  readonly place: Place;
  readonly frame: FrameEntry;
  readonly outline: Outline;
  readonly key: string;
}

/** What the document does not keep of a candidate. */
export type Detail = Pick<MatchedCandidate, 'pose' | 'picture' | 'atBorder' | 'start'>;

/** What a match leaves besides poses: pictures for the panel. Kept as long as its outline is, details of the latest. */
export interface Findings {
  readonly key: string;
  readonly details: readonly Detail[];
  readonly canonicalArea: number;
  /** The outline's canonical silhouette reaches the border of its frame. */
  readonly clipped: boolean;
  /** Pieces of the outline led to the poses: a part of it is unknown or cut off. */
  readonly partial: boolean;
  readonly milliseconds: number;
  /** Refinement has been tried; it is not tried again. */
  readonly tried: boolean;
  /** Why the tried refinement gave nothing, completes "Not refined: ...". */
  readonly refusal: string | null;
}

/** Of so many outlines pictures are kept: undo may lead to thousands. What is looked at again without any is asked again. */
export const PICTURED = 64;

const NOTHING_FOUND = { details: [], canonicalArea: 0, clipped: false, partial: false, milliseconds: 0 };

const NO_MODEL = texts.said.library.withoutModel;

/** How long the outline on view has to be at rest before poses are refined and rivals looked for, ms. */
export const REST = 120;
/** While it changes, its pose is asked for at most so often, ms: what is seen in every screen frame needs the cores too. */
export const PACE = 33;

/**
 * Keeps every closed outline's pose up to date: whenever the document changes it looks for a cell whose result does
 * not belong to its outline and asks the pose worker, one at a time, what is on view first. While a vertex is dragged
 * only the latest outline is ever asked for, and poses that were refined before go along with it; an answer for an
 * outline that is gone is dropped. Once every outline has its pose and the one on view is at rest, poses are refined, in
 * the same order.
 */
export class Poser {
  readonly #store: Store;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  /** Outlines that a worker stopped at. */
  readonly #stoppedAt = new WeakSet<Outline>();
  readonly #findings = new WeakMap<Outline, Findings>();
  /** What they are kept of; the latest comes last. */
  readonly #pictured = new Set<Outline>();
  /** Pages of cells are looked at again when they change, or what poses are found with. */
  readonly #index = new CellIndex<Cell>((entry) => this.#isUnsettled(entry));
  #keyOf: ReturnType<typeof poseKeys> = () => null;
  #busy = false;
  #shownOutline: Outline | null = null;
  #changedAt = -Infinity;
  /** When the pose of an outline was last asked for. */
  #askedAt = -Infinity;
  readonly #pause = new Pause();

  constructor(store: Store, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#store = store;
    this.#worker = worker;
    store.subscribe(() => {
      this.#watch();
      this.#next();
    });
  }

  findings(outline: Outline | null): Findings | null {
    return (outline && this.#findings.get(outline)) ?? null;
  }

  /** Of the candidates that were found for an outline, the one with this pose or the nearest: their order may differ. */
  detail(outline: Outline | null, candidate: Candidate): Detail | null {
    const details = this.findings(outline)?.details ?? [];
    const distances = details.map((detail) => rotationBetween(candidate, detail));
    return details[distances.indexOf(Math.min(...distances))] ?? null;
  }

  /** Notes when the outline on view last changed. */
  #watch(): void {
    const { outline } = currentCell(this.#store.state);
    if (outline === this.#shownOutline) return;
    this.#shownOutline = outline;
    this.#changedAt = performance.now();
  }

  #next(): void {
    this.#pause.end();
    if (this.#busy || this.#adopt()) return;
    const task = this.#find('match') ?? this.#find('refine');
    if (!task) return;
    const rest = this.#restBefore(task);
    if (rest <= 0) return void this.#run(task);
    this.#pause.before(rest, () => this.#next());
  }

  /** How long to wait before a task, ms. */
  #restBefore({ method, outline }: Task): number {
    const now = performance.now();
    if (method === 'refine') return this.#changedAt + REST - now;
    return outline === this.#shownOutline ? this.#askedAt + PACE - now : 0;
  }

  /**
   * Letting go of a point makes a new outline of the same points: what was found for the old one holds. True if it was
   * taken over; the store has then told this class already.
   */
  #adopt(): boolean {
    const { doc, state } = this.#store;
    const place = currentPlace(state);
    const frame = currentFrame(state);
    if (!place || !frame) return false;
    const { outline, result, resultOf } = cellOf(doc, place.frameId, place.component);
    const key = poseKey(doc, place.component, frame);
    const findings = this.findings(resultOf);
    if (!outline || !resultOf || !result || outline === resultOf || !findings) return false;
    if (findings.key !== key || result.origin !== key || !samePoints(outline, resultOf)) return false;
    this.#keep(outline, findings);
    this.#store.amend((doc) => {
      const cell = cellOf(doc, place.frameId, place.component);
      return cell.outline === outline ? withCell(doc, place, { outline, result, resultOf: outline }) : doc;
    });
    return true;
  }

  #find(method: Task['method']): Task | null {
    const { doc, state } = this.#store;
    const shown = currentPlace(state);
    const frame = currentFrame(state);
    const first = shown && frame && this.#task(method, frame, shown.component, true);
    if (first) return first;
    for (const { frameId, component } of this.#unsettled()) {
      const task = this.#task(method, doc.frames[indexOfFrame(doc, frameId)]!, component, false);
      if (task) return task;
    }
    return null;
  }

  /** Closed outlines without a refined pose of what is there now; what was tried in vain is among them. */
  #unsettled(): readonly CellEntry<Cell>[] {
    const { doc } = this.#store;
    const { calibration, components, distortion, frames } = doc;
    const keyOf = poseKeys(doc);
    this.#keyOf = keyOf;
    return inFilmOrder(doc, this.#index.in(doc.cells, calibration, components, distortion, frames));
  }

  #isUnsettled({ frameId, component, cell }: CellEntry<Cell>): boolean {
    const { doc } = this.#store;
    const frame = doc.frames[indexOfFrame(doc, frameId)];
    if (!cell.outline?.closed || !frame) return false;
    const key = this.#keyOf(component, frame);
    if (key === null) return false;
    const isAtRest = isLoaded(cell) || cell.result?.kind === 'failed' || (isRefined(cell.result) && this.findings(cell.outline)?.tried !== false);
    return isStale(cell, key) || !isAtRest;
  }

  #task(method: Task['method'], frame: FrameEntry, component: ComponentName, shown: boolean): Task | null {
    const { doc } = this.#store;
    const cell = cellOf(doc, frame.id, component);
    const { outline } = cell;
    if (!outline?.closed || !isLibraryOpen(this.#store, component)) return null;
    const key = poseKey(doc, component, frame);
    if (!key) return null;
    const place = { frameId: frame.id, component };
    const needed = method === 'match' ? this.#needsMatch(cell, key, shown) : this.#needsRefinement(cell, key, shown);
    return needed ? { method, place, frame, outline, key } : null;
  }

  /** The pictures of refined poses come with the refinement. */
  #needsMatch(cell: Cell, key: string, shown: boolean): boolean {
    if (isStale(cell, key)) return true;
    return shown && !isLoaded(cell) && !isRefined(cell.result) && (this.findings(cell.outline)?.key !== key || this.#lacksPictures(cell));
  }

  #needsRefinement(cell: Cell, key: string, shown: boolean): boolean {
    const { outline, result } = cell;
    if (isStale(cell, key) || isLoaded(cell) || result?.kind !== 'posed') return false;
    const findings = this.findings(outline);
    const tried = findings?.key === key && findings.tried;
    // What was tried for an outline is lost where undo brings back its result from before.
    if (tried && (isRefined(result) || findings.refusal !== null) && !(shown && this.#lacksPictures(cell))) return false;
    return shown || !isRefined(result) || isFollowing(result, findings);
  }

  #lacksPictures({ outline }: Cell): boolean {
    return outline !== null && !this.#pictured.has(outline);
  }

  #keep(outline: Outline, findings: Findings): void {
    this.#findings.set(outline, findings);
    this.#pictured.delete(outline);
    this.#pictured.add(outline);
    for (const oldest of [...this.#pictured].slice(0, -PICTURED)) {
      this.#pictured.delete(oldest);
      const old = this.#findings.get(oldest);
      if (old) this.#findings.set(oldest, { ...old, details: [] });
    }
  }

  async #run(task: Task): Promise<void> {
    this.#busy = true;
    if (task.method === 'match') this.#askedAt = performance.now();
    const { method, place, frame, outline } = task;
    try {
      const camera = cameraOf(this.#store.doc, frame);
      if (!camera) return;
      const { component } = place;
      const input = { component, ...flatten(outline), camera };
      const around = surroundingsOf(this.#store.doc, frame.id, component);
      const before = this.#followable(task);
      const isShown = outline === this.#shownOutline;
      const match = await (method === 'match'
        ? this.#worker.call('match', { ...input, before }, { lane: isShown ? 'live' : 'film' })
        : this.#worker.call('refine', { ...input, around }, { lane: isShown ? 'shown' : 'film' }));
      this.#take(task, match);
    } catch (error) {
      if (!(error instanceof Aborted) && !this.#isTriedAgain(error, outline)) this.#refuse(task, sentenceOf(error));
    } finally {
      this.#busy = false;
      queueMicrotask(() => this.#next());
    }
  }

  /** Refined poses of what the outline was before it was changed: its points have moved, no more. The chosen one comes first. */
  #followable({ place, outline, key }: Task): Refined[] {
    const { result, resultOf } = cellOf(this.#store.doc, place.frameId, place.component);
    if (result?.kind !== 'posed' || result.from !== 'outline' || result.origin !== key) return [];
    if (resultOf?.points.length !== outline.points.length) return [];
    const chosen = result.candidates[result.chosen];
    const order = [...result.candidates].sort((a, b) => Number(b === chosen) - Number(a === chosen));
    return order.flatMap(({ pose, residual }) => (residual === null ? [] : [{ pose, residual }]));
  }

  #take(task: Task, match: Match): void {
    const { outline, key } = task;
    const result = match.refusal === null ? this.#posed(task, match) : failed(match.refusal, key);
    const refused = task.method === 'refine' && result.kind === 'posed' && !isRefined(result);
    const { candidates, canonicalArea, clipped, partial, milliseconds } = match;
    const details = candidates.map(({ pose, picture, atBorder, start }) => ({ pose, picture, atBorder, start }));
    const tried = task.method === 'refine';
    const followed = this.findings(outline)?.tried === false;
    const refusal = refused ? NO_MODEL : null;
    this.#keep(outline, { key, details, canonicalArea, clipped, partial, milliseconds, tried, refusal });
    this.#apply(task, result, followed);
  }

  /** What a tool laid on edges of a frame gives poses that are on it: they are corrected once its film is known. */
  #posed({ method, frame, outline, key }: Task, match: Match): Posed {
    const result = posed(match, key);
    const isOnFrame = method === 'refine' && isRefined(result) && isOnEdges(outline) && !cameraOf(this.#store.doc, frame)?.distortion;
    return isOnFrame ? { ...result, onFrame: { film: null } } : result;
  }

  /** Once: what stops the worker twice is refused. */
  #isTriedAgain(error: unknown, outline: Outline): boolean {
    if (!(error instanceof WorkerStopped) || this.#stoppedAt.has(outline)) return false;
    this.#stoppedAt.add(outline);
    return true;
  }

  /** Nothing was found, or refined. */
  #refuse(task: Task, sentence: string): void {
    const { method, outline, key } = task;
    if (method === 'match') {
      this.#keep(outline, { ...NOTHING_FOUND, key, tried: false, refusal: null });
      this.#apply(task, { kind: 'failed', origin: key, sentence });
      return;
    }
    // The library's pose stays.
    const before = this.findings(outline) ?? NOTHING_FOUND;
    this.#keep(outline, { ...before, key, tried: true, refusal: sentence });
    this.#store.show({});
  }

  /** Takes the result in if it is still wanted: the same outline, the same inputs. What was `followed` is found anew at rest. */
  #apply({ method, place, frame, outline, key }: Task, result: Result, followed = false): void {
    this.#store.amend((doc) => {
      const cell = cellOf(doc, place.frameId, place.component);
      if (cell.outline !== outline || poseKey(doc, place.component, frame) !== key) return doc;
      const said = isRefined(result) || result.kind === 'failed';
      const better = method === 'refine' && said && !isLoaded(cell) && (followed || !isRefined(cell.result));
      if (!isStale(cell, key) && !better) return doc;
      return withCell(doc, place, { outline, result: sameChoice(cell.result, result), resultOf: outline });
    });
    // The pictures are no part of the document: the views are notified all the same.
    this.#store.show({});
  }
}

/**
 * Does the cell's result still have to be found from its outline? Poses from a file stay until the outline changes, one
 * that was set by hand stays until it is dropped.
 */
function isStale({ outline, result, resultOf }: Cell, key: string): boolean {
  if (isByHand(result)) return false;
  if (!result || resultOf !== outline) return true;
  return !isLoaded({ result }) && result.origin !== key;
}

/** Did a refined pose only go along with its outline, to be found anew when that rests? */
export function isFollowing(result: Result | null, findings: Findings | null): boolean {
  return isRefined(result) && findings?.tried === false;
}

/** Given by a person or a file, not found here. */
function isLoaded({ result }: Pick<Cell, 'result'>): boolean {
  return result?.kind === 'posed' && result.from !== 'outline';
}

/**
 * While an outline is dragged, stay with the candidate that was chosen: the one whose pose is nearest to it, if the
 * person chose the rival before.
 */
function sameChoice(before: Result | null, result: Result): Result {
  if (before?.kind !== 'posed' || result.kind !== 'posed' || before.chosen === 0) return result;
  const previous = before.candidates[before.chosen];
  if (!previous) return result;
  const distances = result.candidates.map((candidate) => rotationBetween(previous, candidate));
  return { ...result, chosen: distances.indexOf(Math.min(...distances)) };
}

/** A rough angle between two poses, degrees. */
function rotationBetween(a: Pick<Candidate, 'pose'>, b: Pick<Candidate, 'pose'>): number {
  return Math.hypot(a.pose.xRot - b.pose.xRot, a.pose.yRot - b.pose.yRot);
}

function posed(match: Match, origin: string): Posed {
  const { reason, decided, verdict } = match;
  const candidates = match.candidates.map(({ pose, unmatched, drawn, residual, deviations, judged }) => ({
    pose,
    unmatched,
    drawn,
    residual,
    deviations,
    judged,
  }));
  return { kind: 'posed', from: 'outline', origin, candidates, chosen: 0, reason, decided, verdict, program: PROGRAM };
}

/** No pose fits: the core's reason as a sentence. */
function failed(refusal: string, origin: string): Result {
  return { kind: 'failed', origin, sentence: `${refusal.charAt(0).toUpperCase()}${refusal.slice(1)}` };
}

function samePoints(a: Outline, b: Outline): boolean {
  return (
    a.closed === b.closed &&
    a.laidBy === b.laidBy &&
    a.points.length === b.points.length &&
    a.unknownSides.join() === b.unknownSides.join() &&
    a.points.every(({ column, row }, index) => column === b.points[index]?.column && row === b.points[index]?.row)
  );
}

/** An outline as it goes to the worker. */
export function flatten({ points, unknownSides, laidBy }: Outline): Pick<MatchInput, 'outline' | 'unknownSides' | 'laidBy'> {
  return {
    outline: Float64Array.from(points.flatMap(({ column, row }) => [column, row])),
    unknownSides: Uint32Array.from(unknownSides),
    // Where its click found it, a silhouette lies on edges; a mask lies near them.
    laidBy: laidBy === 'click' ? 'tool' : laidBy === 'mask' ? 'mixed' : (laidBy ?? null),
  };
}
