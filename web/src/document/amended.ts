import { type Cells, partsOf } from './cells';
import { foundWith } from './found_anew';
import { type Cell, cellKey, type Doc } from './types';

/**
 * What the page made of cells while nobody did anything: poses found, refined, chosen, followed so far. It is kept beside the
 * documents that undo and redo lead to: where one of them has a cell as it was, its latest state is shown. What was made of it with
 * another model or calibration is not of that document.
 */
export class Amended {
  /** By what poses were found with. */
  readonly #of = new WeakMap<Cell, Map<string, Cell>>();
  /** Of cells with nothing in them, which are all alike: by the same, and by `cellKey`. */
  readonly #ofNothing = new Map<string, Map<string, Cell>>();

  note(before: Doc, after: Doc): void {
    const inputs = foundWith(after);
    for (const { frameId, component, before: was, after: is } of before.cells.differences(after.cells)) {
      if (!is) continue;
      if (was && !isNothing(was)) at(this.#of, was).set(inputs, is);
      else at(this.#ofNothing, inputs).set(cellKey(frameId, component), is);
      // What comes back is the latest again.
      this.#of.get(is)?.delete(inputs);
    }
  }

  /** The same object where nothing was made of any of its cells. */
  latest(doc: Doc): Doc {
    const inputs = foundWith(doc);
    let cells = doc.cells.map((cell) => this.#latestOf(cell, inputs));
    const ofNothing = this.#ofNothing.get(inputs);
    if (ofNothing) cells = this.#withFromNothing(doc, cells, ofNothing, inputs);
    return cells === doc.cells ? doc : { ...doc, cells };
  }

  #latestOf(cell: Cell, inputs: string): Cell {
    let latest = cell;
    for (let next = this.#of.get(latest)?.get(inputs); next; next = this.#of.get(latest)?.get(inputs)) latest = next;
    return latest;
  }

  #withFromNothing(doc: Doc, cells: Cells<Cell>, ofNothing: ReadonlyMap<string, Cell>, inputs: string): Cells<Cell> {
    const frames = new Set(doc.frames.map(({ id }) => id));
    for (const [key, cell] of ofNothing) {
      const [frameId, component] = partsOf(key);
      const here = cells.at(frameId, component);
      const latest = this.#latestOf(cell, inputs);
      if (frames.has(frameId) && (!here || isNothing(here)) && !isNothing(latest)) cells = cells.with(frameId, component, latest);
    }
    return cells;
  }
}

function isNothing({ outline, result }: Cell): boolean {
  return outline === null && result === null;
}

interface MapLike<K, V> {
  get(key: K): V | undefined;
  set(key: K, value: V): unknown;
}

function at<K, L, V>(maps: MapLike<K, Map<L, V>>, key: K): Map<L, V> {
  const known = maps.get(key);
  if (known) return known;
  const made = new Map<L, V>();
  maps.set(key, made);
  return made;
}
