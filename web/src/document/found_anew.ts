import type { ComponentName } from '../terms/component';
import { type Cell, type Doc, isFromFilm } from './types';

/** The cells of a component, or of all, once its model or the calibration is another. */
export function foundAnew(doc: Doc, of: ComponentName | null): Doc['cells'] {
  return doc.cells.map((cell, _, component) => (of === null || of === component ? anew(cell) : cell));
}

/** How many cells lost a pose that was followed. */
export function droppedIn(before: Doc, after: Doc): number {
  const lost = before.cells.differences(after.cells).filter(({ before: was, after: is }) => isFromFilm(was?.result ?? null) && was?.result?.kind === 'posed' && !is?.result);
  return lost.length;
}

/**
 * A cell whose model, camera or frame is another: what was followed with the one before is dropped, since nothing would tell that it is of that one, and what
 * somebody set or opened is judged anew. What an outline led to names what it was found with, and is found again.
 */
export function anew(cell: Cell): Cell {
  const { result } = cell;
  if (result === null) return cell;
  if (isFromFilm(result)) return { ...cell, result: null, resultOf: null };
  const isGiven = result.kind === 'posed' && (result.from === 'hand' || result.from === 'file');
  return isGiven && result.verdict !== null ? { ...cell, result: { ...result, verdict: null } } : cell;
}
