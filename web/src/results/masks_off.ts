import { CellIndex } from '../document/cells';
import type { Cell, Doc } from '../document/types';
import { UNMET } from '../document/types';
import type { ComponentName } from '../terms/component';

/** How many masks of a component their frames do not bear out, of those whose frames were asked. */
export interface MasksOff {
  readonly off: number;
  readonly of: number;
}

/** So many, and half of them: fewer are single frames, in which something hides the implant. */
const FEWEST = 3;

const ofMasks = new CellIndex<Cell>(({ cell }) => isAsked(cell));

/** Null where most lie on their frames. Where many do not, the plainest cause is that they are of other frames, which no single one tells. */
export function masksOff(doc: Doc, component: ComponentName): MasksOff | null {
  const cells = ofMasks.in(doc.cells).filter((entry) => entry.component === component);
  const off = cells.filter(({ cell }) => isOff(cell)).length;
  return off >= FEWEST && 2 * off >= cells.length ? { off, of: cells.length } : null;
}

/** Was a pose from a mask held against its frame, once its film was known? */
function isAsked({ outline, result, resultOf }: Cell): boolean {
  const isOfMask = outline?.laidBy === 'mask' && resultOf === outline && result?.kind === 'posed' && result.from === 'outline';
  return isOfMask && (result.onFrame?.film != null || result.verdict === UNMET);
}

/** Does the frame itself speak against the pose, whatever rivals and neighbours do? */
export function isOff(cell: Cell): boolean {
  const { result } = cell;
  if (result?.kind !== 'posed' || !isAsked(cell)) return false;
  return result.candidates[result.chosen]?.judged?.verdict.word !== 'good' || result.verdict === UNMET;
}
