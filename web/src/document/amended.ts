import type { Cells } from './cells';
import { type Cell, cellKey, type Doc } from './types';

/**
 * What the page made of cells while nobody did anything: poses found, refined, chosen, followed so far. It is kept beside the
 * documents that undo and redo lead to: where one of them has a cell as it was, its latest state is shown.
 */
export class Amended {
  readonly #of = new WeakMap<Cell, Cell>();
  /** Of cells with nothing in them, which are all alike, by `cellKey`. */
  readonly #ofNothing = new Map<string, Cell>();

  note(before: Cells<Cell>, after: Cells<Cell>): void {
    for (const { frameId, component, before: was, after: is } of before.differences(after)) {
      if (!is) continue;
      if (was && !isNothing(was)) this.#of.set(was, is);
      else this.#ofNothing.set(cellKey(frameId, component), is);
      // What comes back is the latest again.
      this.#of.delete(is);
    }
  }

  /** The same object where nothing was made of any of its cells. */
  latest(doc: Doc): Doc {
    let cells = doc.cells.map((cell) => this.#latestOf(cell));
    if (this.#ofNothing.size > 0) cells = this.#withFromNothing(doc, cells);
    return cells === doc.cells ? doc : { ...doc, cells };
  }

  #latestOf(cell: Cell): Cell {
    let latest = cell;
    for (let next = this.#of.get(latest); next; next = this.#of.get(latest)) latest = next;
    return latest;
  }

  #withFromNothing(doc: Doc, cells: Cells<Cell>): Cells<Cell> {
    const frames = new Set(doc.frames.map(({ id }) => id));
    for (const [key, cell] of this.#ofNothing) {
      const at = key.lastIndexOf('/');
      const [frameId, component] = [key.slice(0, at), key.slice(at + 1) as 'femur' | 'tibia'];
      const here = cells.at(frameId, component);
      const latest = this.#latestOf(cell);
      if (frames.has(frameId) && (!here || isNothing(here)) && !isNothing(latest)) cells = cells.with(frameId, component, latest);
    }
    return cells;
  }
}

function isNothing({ outline, result }: Cell): boolean {
  return outline === null && result === null;
}
