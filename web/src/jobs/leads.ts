import { CellIndex } from '../document/cells';
import { withCell } from '../document/commands';
import { asLed } from '../document/followed';
import { indexOfFrame } from '../document/frame_index';
import type { Store } from '../document/store';
import { type Cell, cellOf, type Doc } from '../document/types';
import { isLeadDoubtful } from '../results/spans';
import { COMPONENT_NAMES } from '../terms/component';

/** Followed poses are no longer doubtful for the one that they were followed from as soon as that one is checked or found good. */
export function keepLeads(store: Store): void {
  let known: Doc | null = null;
  store.subscribe(() => {
    if (store.doc === known) return;
    known = store.doc;
    if (ledCells.in(known.cells).length > 0) store.amend(withLeads);
  });
}

/** The same object where nothing changes. */
export function withLeads(doc: Doc): Doc {
  const [femur, tibia] = COMPONENT_NAMES.map((component) => isLeadDoubtful(doc, component));
  return ledCells.in(doc.cells).reduce((changed, { frameId, component, cell }) => {
    if (cell.result?.kind !== 'posed') return changed;
    const isDoubtful = (component === 'femur' ? femur : tibia)!(indexOfFrame(doc, frameId), cell.result.origin);
    const result = isDoubtful === null ? cell.result : asLed(cell.result, isDoubtful);
    return result === cell.result ? changed : withCell(changed, { frameId, component }, { ...cellOf(changed, frameId, component), result });
  }, doc);
}

const ledCells = new CellIndex<Cell>(({ cell: { result } }) => result?.kind === 'posed' && result.own !== undefined);
