import type { Viewport } from '../geometry/viewport';
import { EDGE_NUMBERS, type EdgeFacts } from '../workers/protocol/by_hand';
import { HALO } from './drawing';

/** For errors and misfits alone, as `--error` of the theme. */
export const MISFIT_COLOUR = '#ff6b5e';

/** Pieces of the outline that lie on no edge, in frame coordinates. */
const paths = new WeakMap<EdgeFacts, Path2D>();

/** Stretches of a model's outline that lie off the frame's edges. */
export function drawMisses(context: CanvasRenderingContext2D, view: Viewport, facts: EdgeFacts): void {
  const path = paths.get(facts) ?? misses(facts);
  paths.set(facts, path);
  context.save();
  context.translate(view.left, view.top);
  context.scale(view.scale, view.scale);
  for (const [colour, width] of [[HALO, 4.5], [MISFIT_COLOUR, 2.5]] as const) {
    context.strokeStyle = colour;
    context.lineWidth = width / view.scale;
    context.stroke(path);
  }
  context.restore();
}

function misses({ numbers }: EdgeFacts): Path2D {
  const path = new Path2D();
  for (let at = 0; at < numbers.length; at += EDGE_NUMBERS) {
    const [column = 0, row = 0, right = 0, down = 0, length = 0, , met] = numbers.subarray(at, at + EDGE_NUMBERS);
    if (met !== 0) continue;
    const [across, along] = [(-down * length) / 2, (right * length) / 2];
    path.moveTo(column - across, row - along);
    path.lineTo(column + across, row + along);
  }
  return path;
}
