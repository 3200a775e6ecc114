import { framePoint, type FramePoint } from './points';

/** Turns and scales about a pivot, then moves: `p -> pivot + scale * rotation * (p - pivot) + by`, in frame pixels. */
export interface Similarity {
  readonly pivot: FramePoint;
  /** Radians, from columns towards rows: clockwise on the screen. */
  readonly angle: number;
  readonly scale: number;
  readonly by: { readonly columns: number; readonly rows: number };
}

const NOWHERE = { columns: 0, rows: 0 };

export function moved(columns: number, rows: number): Similarity {
  return { pivot: framePoint(0, 0), angle: 0, scale: 1, by: { columns, rows } };
}

export function rotated(pivot: FramePoint, angle: number): Similarity {
  return { pivot, angle, scale: 1, by: NOWHERE };
}

export function scaled(pivot: FramePoint, scale: number): Similarity {
  return { pivot, angle: 0, scale, by: NOWHERE };
}

export function transformed({ pivot, angle, scale, by }: Similarity, points: readonly FramePoint[]): readonly FramePoint[] {
  const [cos, sin] = [scale * Math.cos(angle), scale * Math.sin(angle)];
  return points.map(({ column, row }) => {
    const [across, down] = [column - pivot.column, row - pivot.row];
    return framePoint(
      pivot.column + cos * across - sin * down + by.columns,
      pivot.row + sin * across + cos * down + by.rows,
    );
  });
}

/** The upright rectangle around some points. */
export interface Bounds {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

export function boundsOf(points: readonly FramePoint[]): Bounds | null {
  if (points.length === 0) return null;
  const columns = points.map(({ column }) => column);
  const rows = points.map(({ row }) => row);
  return { left: Math.min(...columns), top: Math.min(...rows), right: Math.max(...columns), bottom: Math.max(...rows) };
}

export function middleOf({ left, top, right, bottom }: Bounds): FramePoint {
  return framePoint((left + right) / 2, (top + bottom) / 2);
}
