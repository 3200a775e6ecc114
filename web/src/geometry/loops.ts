import { type FramePoint, framePoint } from './points';

/** A closed outline, and what is marked of its sides. */
interface Ring {
  readonly points: readonly FramePoint[];
  /** Rising; side `i` runs from point `i` to the next. */
  readonly unknownSides: readonly number[];
}

/**
 * The outline without its smaller loops: where two of its sides cross, the shorter way around between them is left out. An outline
 * that does not cross itself is given back as it is.
 */
export function withoutLoops<R extends Ring>(ring: R): R {
  let { points, unknownSides } = ring;
  // Each turn leaves at least one side fewer.
  for (let crossing = firstCrossing(points); crossing; crossing = firstCrossing(points)) {
    ({ points, unknownSides } = cut(points, unknownSides, crossing));
  }
  return points === ring.points ? ring : { ...ring, points, unknownSides };
}

/** Two sides that cross, the earlier first, and where. */
interface Crossing {
  readonly first: number;
  readonly second: number;
  readonly at: FramePoint;
}

export function firstCrossing(points: readonly FramePoint[]): Crossing | null {
  const count = points.length;
  for (let first = 0; first + 2 < count; first++) {
    // Sides that follow each other have a point in common.
    const last = first === 0 ? count - 2 : count - 1;
    for (let second = first + 2; second <= last; second++) {
      const at = crossingOf(points[first]!, points[first + 1]!, points[second]!, points[(second + 1) % count]!);
      if (at) return { first, second, at };
    }
  }
  return null;
}

/** Where two sides cross; null where they only touch. */
function crossingOf(a: FramePoint, b: FramePoint, c: FramePoint, d: FramePoint): FramePoint | null {
  const [abc, abd, cda, cdb] = [turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)];
  if (abc * abd >= 0 || cda * cdb >= 0) return null;
  const part = cda / (cda - cdb);
  return framePoint(a.column + part * (b.column - a.column), a.row + part * (b.row - a.row));
}

/** Twice the area of a triangle, by the way round. */
function turn(a: FramePoint, b: FramePoint, c: FramePoint): number {
  return (b.column - a.column) * (c.row - a.row) - (b.row - a.row) * (c.column - a.column);
}

function cut(points: readonly FramePoint[], unknownSides: readonly number[], { first, second, at }: Crossing): Ring {
  const unknown = points.map((_, side) => unknownSides.includes(side));
  const between = points.slice(first + 1, second + 1);
  const around = [...points.slice(second + 1), ...points.slice(0, first + 1)];
  const isShorter = lengthOf([at, ...between, at]) < lengthOf([at, ...around, at]);
  // Of each way the sides that begin at its points, and of the side that it came in by.
  const [kept, marks] = isShorter
    ? [[...around, at], [...unknown.slice(second + 1), ...unknown.slice(0, first + 1), unknown[second]!]]
    : [[...between, at], [...unknown.slice(first + 1, second + 1), unknown[first]!]];
  return { points: kept, unknownSides: marks.flatMap((isUnknown, side) => (isUnknown ? [side] : [])) };
}

function lengthOf(path: readonly FramePoint[]): number {
  return path.slice(1).reduce((sum, { column, row }, index) => sum + Math.hypot(column - path[index]!.column, row - path[index]!.row), 0);
}
