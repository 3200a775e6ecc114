import type uPlot from 'uplot';
import { type CurvePoint, linesOf } from '../../results/joint_curves';
import { runsOf } from '../../results/motion';

/** Colours that the page's style gives, as the canvas wants them. */
export interface Inks {
  readonly line: string;
  readonly quiet: string;
  readonly ground: string;
  readonly of: Readonly<Record<'only' | 'medial' | 'lateral', string>>;
}

/** How opaque a band is. */
const BAND = 0.22;
/** Radii of points, CSS px; where they would touch they are smaller. */
const POINT = { most: 3.2, least: 1.2 };

export interface Drawn {
  readonly points: readonly CurvePoint[];
  readonly colour: string;
}

/** Bands below lines below points: nothing across a gap. */
export function drawLines(plot: uPlot, lines: readonly Drawn[], ground: string): void {
  const { ctx, bbox } = plot;
  const ratio = devicePixelRatio;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  const at = ({ x }: CurvePoint, value: number): readonly [number, number] => [plot.valToPos(x, 'x', true), plot.valToPos(value, 'y', true)];
  for (const { points, colour } of lines) for (const run of linesOf(points)) drawBand(ctx, run, colour, at);
  for (const { points, colour } of lines) {
    ctx.strokeStyle = colour;
    ctx.lineWidth = 1.4 * ratio;
    ctx.lineJoin = 'round';
    for (const run of linesOf(points)) {
      ctx.beginPath();
      for (const point of run) ctx.lineTo(...at(point, point.value));
      ctx.stroke();
    }
    const apart = bbox.width / ratio / Math.max(1, points.length);
    const radius = ratio * Math.max(POINT.least, Math.min(POINT.most, 0.45 * apart));
    for (const point of points) if (!point.impossible) drawPoint(ctx, point, at(point, point.value), radius, colour, ground);
  }
  ctx.restore();
}

function drawBand(ctx: CanvasRenderingContext2D, run: readonly CurvePoint[], colour: string, at: (point: CurvePoint, value: number) => readonly [number, number]): void {
  const known = runsOf(run.filter(({ deviation }) => Number.isFinite(deviation)));
  ctx.globalAlpha = BAND;
  ctx.fillStyle = ctx.strokeStyle = colour;
  for (const part of known) {
    ctx.beginPath();
    for (const point of part) ctx.lineTo(...at(point, point.value + point.deviation));
    for (const point of [...part].reverse()) ctx.lineTo(...at(point, point.value - point.deviation));
    ctx.closePath();
    ctx.fill();
    // A frame by itself has no width.
    if (part.length === 1) ctx.stroke();
  }
  ctx.globalAlpha = 1;
}

/** Hollow where it is doubtful, square where it was checked. */
function drawPoint(ctx: CanvasRenderingContext2D, { doubtful, checked }: CurvePoint, [x, y]: readonly [number, number], radius: number, colour: string, ground: string): void {
  ctx.beginPath();
  if (checked) ctx.rect(x - radius, y - radius, 2 * radius, 2 * radius);
  else ctx.arc(x, y, radius, 0, 2 * Math.PI);
  ctx.fillStyle = doubtful ? ground : colour;
  ctx.fill();
  if (!doubtful) return;
  ctx.lineWidth = Math.max(1, 0.45 * radius);
  ctx.strokeStyle = colour;
  ctx.stroke();
}

/** What positive numbers mean, above the upper end of their axis; what the curve runs over, before the first of its ticks. */
export function drawWords(plot: uPlot, sign: string, over: string, ink: string): void {
  const { ctx, bbox } = plot;
  const ratio = devicePixelRatio;
  ctx.save();
  ctx.fillStyle = ink;
  ctx.font = `${11 * ratio}px ${FONT}`;
  ctx.textBaseline = 'bottom';
  ctx.textAlign = 'left';
  ctx.fillText(sign, bbox.left - 4 * ratio, bbox.top - 2 * ratio);
  ctx.textBaseline = 'top';
  ctx.textAlign = 'right';
  ctx.fillText(over, bbox.left - 10 * ratio, bbox.top + bbox.height + 6 * ratio);
  ctx.restore();
}

export const FONT = 'system-ui, -apple-system, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif';

/** The point nearest to a place of the plot, CSS px; null where none is near. */
export function nearestPoint(plot: uPlot, points: readonly CurvePoint[], left: number, top: number, over: 'x alone' | 'both'): CurvePoint | null {
  let [nearest, least]: [CurvePoint | null, number] = [null, Infinity];
  for (const point of points) {
    const across = plot.valToPos(point.x, 'x') - left;
    const away = over === 'both' ? Math.hypot(across, plot.valToPos(point.value, 'y') - top) : Math.abs(across);
    if (away < least) [nearest, least] = [point, away];
  }
  return nearest;
}
