import { distortionKey } from './distortion';
import { isSilhouette } from './laid_by';
import type { ComponentName } from '../terms/component';
import { withOtherPoses } from './marks';
import { type Cell, type Doc, isFromFilm } from './types';

/** What all poses of a document are found with, the frames apart. */
export function foundWith({ components: { femur, tibia }, calibration, distortion }: Doc): string {
  return JSON.stringify([femur.model?.sha256, tibia.model?.sha256, calibration?.text, distortion && distortionKey(distortion)]);
}

/** The document once the model of a component is another, or, for all, the calibration: what a person checked of a pose was not this one. */
export function foundAnew(doc: Doc, of: ComponentName | null): Doc {
  const isConcerned = (component: ComponentName) => of === null || of === component;
  const cells = doc.cells.map((cell, _, component) => (isConcerned(component) ? anew(cell) : cell));
  return { ...doc, cells, marks: withOtherPoses(doc, (_, component) => isConcerned(component)) };
}

/** How many cells lost a pose that was followed, or that a click led to. */
export function droppedIn(before: Doc, after: Doc): number {
  const lost = before.cells.differences(after.cells).filter(({ before: was, after: is }) => {
    const isGone = isFromFilm(was?.result ?? null) || (isSilhouette(was?.outline ?? null) && !is?.outline);
    return isGone && was?.result?.kind === 'posed' && !is?.result;
  });
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
  if (!isGiven || (result.verdict === null && !result.rivals)) return cell;
  // What had been found there was found with the one before.
  const { rivals: _, ...given } = result;
  return { ...cell, result: { ...given, verdict: null } };
}
