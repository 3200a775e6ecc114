import { CellIndex } from '../document/cells';
import { withCell } from '../document/commands';
import type { Place } from '../document/command';
import { inFilmOrder } from '../document/frame_index';
import { withItsOutline } from '../document/own_outlines';
import type { Store } from '../document/store';
import { type Candidate, type Cell, cellOf, isRefined, type Posed, type Verdict } from '../document/types';
import { Aborted, type Bridge } from '../workers/bridge';
import type { PoseProtocol } from '../workers/protocol/pose';
import type { Choice, Surroundings } from '../workers/protocol/match';
import { middleOf } from '../geometry/mesh_middle';
import { sentenceOf, type Services } from './services';
import { surroundingsOf } from '../results/surroundings';
import { texts } from '../texts/texts';

interface Open {
  readonly place: Place;
  readonly result: Posed;
  readonly around: Surroundings;
}

/**
 * Chooses anew between rivals of which none was decided, or the one that was is doubtful, whenever more has become known
 * around them: the femur was posed after the tibia, or the frame before after this one. What was decided and is good stays
 * so, what a person chose by hand is left alone, and nothing doubtful speaks for others, so this comes to an end.
 */
export class Chooser {
  readonly #store: Store;
  readonly #studio: Services['studio'];
  readonly #worker: Pick<Bridge<PoseProtocol>, 'call'>;
  /** What was known around a result when its choice was last made. */
  readonly #knownThen = new WeakMap<readonly Candidate[], string>();
  #busy = false;

  constructor({ store, studio }: Pick<Services, 'store' | 'studio'>, worker: Pick<Bridge<PoseProtocol>, 'call'>) {
    this.#store = store;
    this.#studio = studio;
    this.#worker = worker;
    store.subscribe(() => void this.#next());
  }

  async #next(): Promise<void> {
    if (this.#busy) return;
    const open = this.#find();
    if (!open) return;
    this.#busy = true;
    this.#knownThen.set(open.result.candidates, JSON.stringify(open.around));
    try {
      const { place, result, around } = open;
      const { component } = place;
      const candidates = result.candidates.map(({ pose, residual, deviations, judged }) => ({ pose, deviations, residual: judged?.misfit ?? residual ?? NaN }));
      const mesh = this.#studio.meshOf(this.#store.doc.components[component].model?.sha256 ?? '');
      const choice = await this.#worker.call('choose', { component, candidates, middle: mesh && middleOf(mesh), around });
      if (choice) this.#apply(open, choice);
    } catch (error) {
      if (!(error instanceof Aborted)) this.#store.say('error', texts.said.noChoice(sentenceOf(error)));
    } finally {
      this.#busy = false;
      queueMicrotask(() => void this.#next());
    }
  }

  #find(): Open | null {
    const { doc } = this.#store;
    for (const { frameId, component, cell } of inFilmOrder(doc, openChoices.in(doc.cells))) {
      if (!isOpen(cell)) continue;
      const around = surroundingsOf(doc, frameId, component);
      if (around.counterpart === null && around.neighbours.length === 0) continue;
      if (this.#knownThen.get(cell.result.candidates) === JSON.stringify(around)) continue;
      return { place: { frameId, component }, result: cell.result, around };
    }
    return null;
  }

  #apply({ place, result }: Open, { index, decided, reason, doubt }: Choice): void {
    this.#store.amend((doc) => {
      const cell = cellOf(doc, place.frameId, place.component);
      // What its joint tells may have come meanwhile.
      if (cell.result?.kind !== 'posed' || cell.result.candidates !== result.candidates || cell.result.chosen !== result.chosen) return doc;
      const first = result.candidates[index];
      const others = result.candidates.filter((candidate) => candidate !== first);
      const candidates = index === 0 || !first ? result.candidates : [first, ...others];
      const known = this.#knownThen.get(result.candidates);
      if (known !== undefined) this.#knownThen.set(candidates, known);
      return withCell(doc, place, { ...withItsOutline(cell, first), result: { ...cell.result, candidates, decided, reason, verdict: withDoubt(first, doubt) } });
    });
  }
}

/** What is doubtful about a pose by itself comes before another one that fits as well. */
function withDoubt(candidate: Candidate | undefined, doubt: string | null): Verdict | null {
  const alone = candidate?.judged?.verdict ?? null;
  return alone?.word === 'good' && doubt !== null ? { word: 'doubtful', because: doubt } : alone;
}

const openChoices = new CellIndex<Cell>(({ cell }) => isOpen(cell));

/** Refined rivals of which none was decided or the one that was is doubtful, nor any chosen by hand. */
function isOpen(cell: Cell): cell is Cell & { result: Posed } {
  const { result, outline, resultOf } = cell;
  if (result?.kind !== 'posed' || result.from !== 'outline' || resultOf !== outline) return false;
  const settled = result.decided && result.verdict?.word !== 'doubtful';
  return result.candidates.length > 1 && result.chosen === 0 && !settled && isRefined(result);
}
