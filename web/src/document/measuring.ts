import { type FramePoint, framePoint } from '../geometry/points';

/** What the calibration helper has before it: no part of the document until somebody takes what it found. */
export interface Measuring {
  readonly kind: 'grid' | 'ruler';
  /** The beads of a picture, and what they say of its distortion; null until they have been looked for. */
  readonly grid: MeasuredGrid | null;
  /** None, one or two marks on a ruler, on the frame as it is shown. */
  readonly marks: readonly FramePoint[];
}

export interface MeasuredGrid {
  readonly frameId: string;
  readonly frameName: string;
  readonly width: number;
  readonly height: number;
  /** Column and row in the frame as taken, number to the right and number down, of each bead. */
  readonly beads: Float64Array<ArrayBuffer>;
  /** Round marks in the picture, those of no lattice too. */
  readonly marks: number;
  readonly radius: number;
  readonly distortion: MeasuredDistortion | null;
  /** Why there is no distortion to correct; null where there is. */
  readonly refusal: string | null;
}

export interface MeasuredDistortion {
  readonly numbers: Float64Array<ArrayBuffer>;
  /** Beads used and dropped; residual before and after; left out for orders 3, 4, 5 (NaN: too few beads); largest shift. Px. */
  readonly quality: Float64Array<ArrayBuffer>;
  /** Of each bead: place, offset from the regular lattice before, offset after; columns and rows, px. */
  readonly residuals: Float64Array<ArrayBuffer>;
}

export const NOTHING_MEASURED: Measuring = { kind: 'grid', grid: null, marks: [] };

/** A mark under way: the nearest one comes along. */
export function withMovedMark(marks: readonly FramePoint[], at: FramePoint): readonly FramePoint[] {
  return marks.length < 2 ? [at] : withMark(marks, at);
}

/** Another click: the first mark, the second, or the nearer of the two moved there. */
export function withMark(marks: readonly FramePoint[], at: FramePoint): readonly FramePoint[] {
  if (marks.length < 2) return [...marks, at];
  const away = marks.map((mark) => Math.hypot(mark.column - at.column, mark.row - at.row));
  return marks.with((away[0] ?? 0) <= (away[1] ?? 0) ? 0 : 1, at);
}

/** The marks with a number that somebody typed; a mark without numbers is none. */
export function withTyped(marks: readonly FramePoint[], index: number, typed: Partial<Pick<FramePoint, 'column' | 'row'>>): readonly FramePoint[] {
  const all = [0, 1].map((at) => marks[at] ?? framePoint(NaN, NaN));
  const { column, row } = { ...(all[index] ?? framePoint(NaN, NaN)), ...typed };
  return all.with(index, framePoint(column, row)).filter((mark) => !Number.isNaN(mark.column) || !Number.isNaN(mark.row));
}
