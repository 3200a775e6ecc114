import type { Measuring } from '../document/measuring';
import { framePoint, type FramePoint } from '../geometry/points';
import { canvasFromFrame, type Viewport } from '../geometry/viewport';

type Context = CanvasRenderingContext2D;

const HALO = 'rgb(0 0 0 / 0.6)';
/** Neither component's colour. */
const MARK = '#f0e442';
const TAU = 2 * Math.PI;

/** Beads with the lattice that joins them, or the marks of a ruler, over the frame. `beads` are where the frame shows them. */
export function drawMeasuring(context: Context, view: Viewport, measuring: Measuring, beads: Float64Array | null): void {
  context.save();
  context.lineJoin = 'round';
  if (measuring.kind === 'grid' && beads) drawBeads(context, view, beads, measuring.grid?.radius ?? 4);
  if (measuring.kind === 'ruler') drawRuler(context, view, measuring.marks);
  context.restore();
}

function drawBeads(context: Context, view: Viewport, beads: Float64Array, radius: number): void {
  const places = new Map<string, FramePoint>();
  for (let at = 0; at + 3 < beads.length; at += 4) {
    places.set(`${beads[at + 2]} ${beads[at + 3]}`, framePoint(beads[at] ?? 0, beads[at + 1] ?? 0));
  }
  const lattice = new Path2D();
  const circles = new Path2D();
  for (const [number, place] of places) {
    const [i = 0, j = 0] = number.split(' ').map(Number);
    const from = canvasFromFrame(view, place);
    for (const next of [places.get(`${i + 1} ${j}`), places.get(`${i} ${j + 1}`)]) {
      if (!next) continue;
      const to = canvasFromFrame(view, next);
      lattice.moveTo(from.x, from.y);
      lattice.lineTo(to.x, to.y);
    }
    const reach = Math.max(3, 1.4 * radius * view.scale);
    circles.moveTo(from.x + reach, from.y);
    circles.arc(from.x, from.y, reach, 0, TAU);
  }
  context.globalAlpha = 0.55;
  stroke(context, lattice, 1);
  context.globalAlpha = 1;
  stroke(context, circles, 1.5);
}

function drawRuler(context: Context, view: Viewport, marks: readonly FramePoint[]): void {
  const places = marks.filter(({ column, row }) => !Number.isNaN(column) && !Number.isNaN(row)).map((mark) => canvasFromFrame(view, mark));
  const path = new Path2D();
  const [a, b] = places;
  if (a && b) {
    path.moveTo(a.x, a.y);
    path.lineTo(b.x, b.y);
  }
  for (const { x, y } of places) {
    for (const [right, down] of [[1, 0], [-1, 0], [0, 1], [0, -1]] as const) {
      path.moveTo(x + 4 * right, y + 4 * down);
      path.lineTo(x + 12 * right, y + 12 * down);
    }
  }
  stroke(context, path, 1.5);
}

function stroke(context: Context, path: Path2D, width: number): void {
  context.strokeStyle = HALO;
  context.lineWidth = width + 2;
  context.stroke(path);
  context.strokeStyle = MARK;
  context.lineWidth = width;
  context.stroke(path);
}
