import { COMPONENT_COLOURS } from '../controls/colours';
import { MISFIT_COLOUR } from '../stage/misses';
import type { ComponentName } from '../terms/component';
import { EDGE_NUMBERS, type EdgeFacts } from '../workers/protocol/by_hand';

/** Edges are drawn so many times as far off the outline as they lie. */
export const TIMES = 5;
/** Pieces are drawn so many times as long as they are, to reach into each other: those that are read do not stand evenly. */
const LONGER = 1.4;
/** Edges farther off than this may leave the picture, frame px: few are. */
const FARTHEST = 2;
const OUTLINE_COLOUR = '#8b9096';

interface Piece {
  readonly at: readonly [number, number];
  readonly normal: readonly [number, number];
  /** Half of it, frame px. */
  readonly half: number;
  /** Frame px; NaN where there is no edge. */
  readonly beyond: number;
  /** 1, 0, or NaN where nothing can be told. */
  readonly met: number;
}

/** The outline, and beside it the edges: those on it in the component's colour; the outline itself in red where there are none. */
export function paintEdges(context: CanvasRenderingContext2D, { numbers }: EdgeFacts, component: ComponentName): void {
  const { width, height } = context.canvas;
  context.clearRect(0, 0, width, height);
  const pieces = piecesOf(numbers);
  const place = placing(pieces, width, height);
  const line = (colour: string, thick: number, chosen: (piece: Piece) => boolean, off: (piece: Piece) => number) => {
    context.beginPath();
    for (const piece of pieces.filter(chosen)) {
      const { normal, half } = piece;
      const far = off(piece);
      const middle = [piece.at[0] + far * normal[0], piece.at[1] + far * normal[1]] as const;
      context.moveTo(...place(middle[0] - normal[1] * half, middle[1] + normal[0] * half));
      context.lineTo(...place(middle[0] + normal[1] * half, middle[1] - normal[0] * half));
    }
    context.strokeStyle = colour;
    context.lineWidth = thick;
    context.stroke();
  };
  line(OUTLINE_COLOUR, 1, () => true, () => 0);
  line(COMPONENT_COLOURS[component].css, 2.5, ({ met }) => met === 1, ({ beyond }) => TIMES * beyond);
  line(MISFIT_COLOUR, 4, ({ met }) => met === 0, () => 0);
}

function piecesOf(numbers: Float32Array): Piece[] {
  return Array.from({ length: numbers.length / EDGE_NUMBERS }, (_, piece) => {
    const [column = 0, row = 0, right = 0, down = 0, length = 0, beyond = NaN, met = NaN] = numbers.subarray(EDGE_NUMBERS * piece);
    return { at: [column, row], normal: [right, down], half: (LONGER * length) / 2, beyond, met } as const;
  });
}

/** From the frame into the picture: the outline as large as it may be. */
function placing(pieces: readonly Piece[], width: number, height: number): (column: number, row: number) => [number, number] {
  const [columns, rows] = [pieces.map(({ at }) => at[0]), pieces.map(({ at }) => at[1])];
  const margin = TIMES * FARTHEST;
  const [left, top] = [least(columns) - margin, least(rows) - margin];
  const [across, down] = [-least(columns.map((x) => -x)) + margin - left, -least(rows.map((y) => -y)) + margin - top];
  const scale = Math.min(width / across, height / down);
  return (column, row) => [width / 2 + scale * (column - left - across / 2), height / 2 + scale * (row - top - down / 2)];
}

function least(values: readonly number[]): number {
  return values.reduce((a, b) => Math.min(a, b), Infinity);
}
