import type { Outline } from '../document/types';
import type { ComponentName } from '../terms/component';
import type { Preview } from '../tracing/preview';
import type { CanvasPoint, FramePoint } from '../geometry/points';
import { boundsOf } from '../geometry/similarity';
import { canvasFromFrame, type Viewport } from '../geometry/viewport';
import { holdOf, STRETCH_REACH } from '../interaction/stretch';
import { cornerOf, CORNERS, handleAt, turnHandle, type Handle } from '../interaction/transform';
import { COMPONENT_COLOURS } from '../controls/colours';

/** What tools show on the frame before they do it. */

type Context = CanvasRenderingContext2D;

const HALO = 'rgb(0 0 0 / 0.55)';
const DARK = 'rgb(20 22 24 / 0.85)';
const TAU = 2 * Math.PI;

export function drawPreview(context: Context, view: Viewport, component: ComponentName, preview: Preview): void {
  const { css, light } = COMPONENT_COLOURS[component];
  switch (preview.kind) {
    case 'nothing':
      return;
    case 'spot':
      return drawSpot(context, canvasFromFrame(view, preview.at), css);
    case 'path':
      return strokeTwice(context, pathOf(view, preview.points, false), light, 1.75);
    case 'ring':
      return drawRing(context, pathOf(view, preview.points, true), css, light);
    case 'box':
      return drawBox(context, canvasFromFrame(view, preview.from), canvasFromFrame(view, preview.to), css);
  }
}

function drawSpot(context: Context, { x, y }: CanvasPoint, colour: string): void {
  const ring = new Path2D();
  ring.arc(x, y, 5, 0, TAU);
  strokeTwice(context, ring, colour, 1.5);
}

function drawRing(context: Context, ring: Path2D, colour: string, light: string): void {
  context.save();
  context.globalAlpha = 0.18;
  context.fillStyle = colour;
  context.fill(ring, 'evenodd');
  context.restore();
  strokeTwice(context, ring, light, 1.25);
}

function drawBox(context: Context, from: CanvasPoint, to: CanvasPoint, colour: string): void {
  const box = new Path2D();
  box.rect(Math.min(from.x, to.x), Math.min(from.y, to.y), Math.abs(to.x - from.x), Math.abs(to.y - from.y));
  context.save();
  context.setLineDash([6, 4]);
  strokeTwice(context, box, colour, 1.5);
  context.restore();
}

/** The box around an outline with its handles; the one under the pointer stands out. */
export function drawTransformBox(
  context: Context,
  view: Viewport,
  component: ComponentName,
  outline: Outline,
  pointer: CanvasPoint | null,
): void {
  const bounds = boundsOf(outline.points);
  if (!bounds) return;
  const { css } = COMPONENT_COLOURS[component];
  const hovered = pointer && handleAt(bounds, view, pointer);
  const corners = CORNERS.map((corner) => [corner, canvasFromFrame(view, cornerOf(bounds, corner))] as const);
  const turn = turnHandle(bounds, view);
  const box = new Path2D();
  for (const [, { x, y }] of corners) box.lineTo(x, y);
  box.closePath();
  box.moveTo(turn.x, turn.y);
  box.lineTo(turn.x, corners[0]![1].y);
  context.save();
  context.setLineDash([4, 4]);
  strokeTwice(context, box, css, 1);
  context.restore();
  for (const [corner, at] of corners) drawGrip(context, at, css, corner === hovered, false);
  drawGrip(context, turn, css, hovered === ('turn' satisfies Handle), true);
}

function drawGrip(context: Context, { x, y }: CanvasPoint, colour: string, hovered: boolean, round: boolean): void {
  const size = hovered ? 6 : 5;
  const grip = new Path2D();
  if (round) grip.arc(x, y, size, 0, TAU);
  else grip.rect(x - size, y - size, 2 * size, 2 * size);
  context.fillStyle = DARK;
  context.fill(grip);
  strokeTwice(context, grip, hovered ? '#ffffff' : colour, 1.5);
}

/** Where a press would take hold of the outline. */
export function drawHold(context: Context, view: Viewport, component: ComponentName, outline: Outline, pointer: CanvasPoint | null): void {
  const hold = pointer && holdOf(outline, view, pointer);
  if (!hold || hold.away > STRETCH_REACH) return;
  const from = outline.points[hold.side]!;
  const to = outline.points[(hold.side + 1) % outline.points.length]!;
  const side = pathOf(view, [from, to], false);
  strokeTwice(context, side, COMPONENT_COLOURS[component].light, 3);
}

/** The brush as large as it paints: dashed where it takes away. */
export function drawBrush(context: Context, component: ComponentName, { x, y }: CanvasPoint, radius: number, erase: boolean): void {
  const disc = new Path2D();
  disc.arc(x, y, Math.max(1, radius), 0, TAU);
  context.save();
  if (erase) context.setLineDash([4, 3]);
  strokeTwice(context, disc, COMPONENT_COLOURS[component].light, 1.25);
  context.restore();
}

/** Where keys point; its middle is open, so that what lies there is seen. */
export function drawCross(context: Context, component: ComponentName, { x, y }: CanvasPoint): void {
  const [from, to] = [4, 14];
  const arms = new Path2D();
  for (const sign of [-1, 1]) {
    arms.moveTo(x + sign * from, y);
    arms.lineTo(x + sign * to, y);
    arms.moveTo(x, y + sign * from);
    arms.lineTo(x, y + sign * to);
  }
  strokeTwice(context, arms, COMPONENT_COLOURS[component].light, 1.5);
}

function pathOf(view: Viewport, points: readonly FramePoint[], closed: boolean): Path2D {
  const path = new Path2D();
  for (const { column, row } of points) path.lineTo(column * view.scale + view.left, row * view.scale + view.top);
  if (closed) path.closePath();
  return path;
}

/** On a dark edge, so that it is seen on any frame. */
function strokeTwice(context: Context, path: Path2D, colour: string, width: number): void {
  context.lineJoin = 'round';
  context.strokeStyle = HALO;
  context.lineWidth = width + 2;
  context.stroke(path);
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke(path);
}
