import { CellIndex } from '../document/cells';
import type { Place } from '../document/command';
import { inFilmOrder } from '../document/frame_index';
import { withHandVerdict } from '../document/hand_poses';
import { currentPlace } from '../document/store';
import { type Cell, cellOf, chosenCandidate, type Posed, type Result, type Verdict } from '../document/types';
import { cameraOf, poseKeyAt } from '../results/keys';
import { aroundHand } from '../results/surroundings';
import { Aborted, type Bridge } from '../workers/bridge';
import type { PoseProtocol } from '../workers/protocol/pose';
import { frameOf, onFrameInput } from './from_here';
import { isLibraryOpen } from './library_ready';
import { Pause } from './pause';
import { flatten } from './poser';
import type { Services } from './services';

interface Task {
  readonly place: Place;
  readonly cell: Cell & { readonly result: Posed };
}

/** How long a pose has to be left alone before it is judged, ms: nobody wants it while the hand moves. */
export const HAND_REST = 200;

/**
 * Says how far poses that somebody set, or brought in a file, are to be trusted: by the closed outline of their cell, else by the frame. When the
 * outline changes afterwards they are judged again. The pose itself stays, whatever is said of it.
 */
export class HandJudge {
  readonly #services: Services;
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  /** Nothing could be held against these; with the outline they had, and what they would have been judged by. */
  readonly #untold = new WeakMap<Posed, { readonly outline: Cell['outline']; readonly key: string | null }>();
  readonly #pause = new Pause();
  #busy = false;

  constructor(services: Services, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#services = services;
    this.#worker = worker;
    services.store.subscribe(() => this.#consider());
  }

  #consider(): void {
    this.#pause.end();
    const task = this.#busy ? null : this.#find();
    if (!task) return;
    this.#pause.before(isOfFile(task.cell.result) ? 0 : HAND_REST, () => void this.#next());
  }

  #find(): Task | null {
    const { store } = this.#services;
    const shown = currentPlace(store.state);
    const places = inFilmOrder(store.doc, givenPoses.in(store.doc.cells));
    for (const { frameId, component } of shown ? [shown, ...places] : places) {
      const cell = cellOf(store.doc, frameId, component);
      if (this.#isUnjudged(cell, poseKeyAt(store.doc, { frameId, component })) && isLibraryOpen(store, component)) return { place: { frameId, component }, cell };
    }
    return null;
  }

  #isUnjudged(cell: Cell, key: string | null): cell is Task['cell'] {
    const { result, resultOf, outline } = cell;
    if (!isGiven(result)) return false;
    const isOld = isClosed(resultOf) !== isClosed(outline) || (isClosed(outline) && resultOf !== outline);
    const untold = this.#untold.get(result);
    return (result.verdict === null || isOld) && !(untold && untold.outline === outline && untold.key === key);
  }

  async #next(): Promise<void> {
    const task = this.#find();
    if (!task) return;
    this.#busy = true;
    const { place, cell } = task;
    const { store } = this.#services;
    const key = poseKeyAt(store.doc, place);
    try {
      const verdict = await this.#ask(task);
      const isAsBefore = poseKeyAt(store.doc, place) === key && cellOf(store.doc, place.frameId, place.component).outline === cell.outline;
      if (isAsBefore) store.amend((doc) => withHandVerdict(doc, place, cell.result, verdict));
    } catch (error) {
      // Without pixels or a model nobody can say; the pose is there all the same.
      if (!(error instanceof Aborted)) this.#untold.set(cell.result, { outline: cell.outline, key });
    } finally {
      this.#busy = false;
      this.#consider();
    }
  }

  async #ask({ place, cell }: Task): Promise<Verdict> {
    const { doc } = this.#services.store;
    const pose = chosenCandidate(cell)!.pose;
    const camera = cameraOf(doc, frameOf(doc, place));
    const around = aroundHand(doc, place);
    if (isClosed(cell.outline) && cell.outline && camera) {
      return this.#worker.call('judgeOutline', { component: place.component, ...flatten(cell.outline), camera, pose, around });
    }
    const input = await onFrameInput(this.#services, place);
    return this.#worker.call('judgeOnFrame', { ...input, pose, around }, { transfer: [input.frame.pixels.buffer] });
  }
}

const givenPoses = new CellIndex<Cell>(({ cell }) => isGiven(cell.result));

function isGiven(result: Result | null): result is Posed {
  return result?.kind === 'posed' && (result.from === 'hand' || isOfFile(result));
}

/** No hand moves it. */
function isOfFile({ from }: Posed): boolean {
  return from === 'file';
}

function isClosed(outline: Cell['outline']): boolean {
  return outline?.closed ?? false;
}
