import { framePoint, type FramePoint } from '../geometry/points';
import type { Command } from './command';
import { fits, type Distortion } from './distortion';
import { anew } from './found_anew';
import { withOtherPoses } from './marks';
import type { Cell, Doc, Outline } from './types';
import { texts } from '../texts/texts';

/** Columns and rows by turns, moved. */
export type MovePoints = (points: Float64Array<ArrayBuffer>) => ArrayLike<number>;

/**
 * Takes another correction, or none. Outlines stay on what they were traced on: where frames become undistorted, or are
 * no longer so, their points go with them. `fromShown` and `toShown` do that for the correction before and after.
 */
export function setDistortion(distortion: Distortion | null, fromShown: MovePoints | null, toShown: MovePoints | null): Command {
  const move = (points: readonly FramePoint[]): readonly FramePoint[] => {
    const flat = Float64Array.from(points.flatMap(({ column, row }) => [column, row]));
    const raw = fromShown ? Float64Array.from(fromShown(flat)) : flat;
    const shown = toShown ? toShown(raw) : raw;
    return points.map((_, index) => framePoint(shown[2 * index] ?? 0, shown[2 * index + 1] ?? 0));
  };
  return {
    label: distortion ? texts.steps.correctDistortion : texts.steps.leaveDistortion,
    apply: (doc) => {
      const moves = fromShown !== null || toShown !== null;
      const concerned = concernedBy(doc, distortion);
      const marks = withOtherPoses(doc, (frameId) => concerned.has(frameId));
      return { ...doc, distortion, cells: cellsIn(doc, concerned, moves ? move : null), marks };
    },
  };
}

/** Frames that look otherwise, or whose outlines mean others than before. */
function concernedBy(doc: Doc, next: Distortion | null): ReadonlySet<string> {
  return new Set(doc.frames.filter((frame) => fits(doc.distortion, frame) || fits(next, frame)).map(({ id }) => id));
}

/** Their poses are found anew. */
function cellsIn(doc: Doc, concerned: ReadonlySet<string>, move: ((points: readonly FramePoint[]) => readonly FramePoint[]) | null): Doc['cells'] {
  const moved = (outline: Outline | null) => outline && move && { ...outline, points: move(outline.points) };
  const changed = (cell: Cell): Cell => {
    const outline = moved(cell.outline);
    return anew(outline ? { ...cell, outline } : cell);
  };
  return doc.cells.map((cell, frameId) => (concerned.has(frameId) ? changed(cell) : cell));
}
