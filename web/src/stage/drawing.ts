import type { ComponentName } from '../terms/component';
import type { Box } from '../films/studio';
import { distance, type CanvasPoint } from '../geometry/points';
import type { Viewport } from '../geometry/viewport';
import type { Hit } from '../interaction/hit';
import { COMPONENT_COLOURS } from '../controls/colours';
import type { OverlayLayer } from './layers';

type Context = CanvasRenderingContext2D;

/** Dark under every line: the frame behind may be as bright as the line. */
export const HALO = 'rgb(0 0 0 / 0.55)';
const TAU = 2 * Math.PI;

export function drawSilhouette(context: Context, view: Viewport, { border, box, canvas, component }: OverlayLayer, opacity: number): void {
  if (!border || opacity === 0) return;
  const { css, light } = COMPONENT_COLOURS[component];
  context.save();
  context.translate(view.left, view.top);
  context.scale(view.scale, view.scale);
  context.globalAlpha = opacity;
  context.fillStyle = css;
  if (box) drawPart(context, canvas, box, view);
  else context.fill(border);
  context.globalAlpha = Math.min(1, opacity * 2);
  // A line of one pixel is drawn three times as fast as a wider one along so many corners.
  context.lineWidth = 1 / view.scale;
  context.strokeStyle = light;
  context.stroke(border);
  context.restore();
}

/** The box alone: without a graphics card an empty pixel costs as much as a full one. */
function drawPart(context: Context, canvas: HTMLCanvasElement, { left, top, width, height }: Box, view: Viewport): void {
  context.imageSmoothingEnabled = view.scale * devicePixelRatio < 3;
  if (width > 0) context.drawImage(canvas, left, top, width, height, left, top, width, height);
}

interface OutlineStyle {
  readonly closed: boolean;
  /** Numbers of the sides that are drawn dashed. */
  readonly unknownSides: readonly number[];
  readonly active: boolean;
  /** Something else is what counts: it is only where it was. */
  readonly faint: boolean;
  readonly handles: boolean;
  readonly hit: Hit;
  readonly selected: number | null;
  readonly pointer: CanvasPoint | null;
}

const FAINT = 0.45;

export function drawOutline(context: Context, component: ComponentName, points: readonly CanvasPoint[], style: OutlineStyle): void {
  const colour = COMPONENT_COLOURS[component].css;
  const { known, unknown } = paths(points, style);
  context.save();
  context.lineJoin = 'round';
  context.globalAlpha = style.faint ? FAINT : style.active ? 1 : 0.6;
  if (!style.faint) stroke(context, known, HALO, 3.5);
  stroke(context, known, colour, style.faint ? 1 : 1.5);
  context.setLineDash([7, 7]);
  stroke(context, unknown, HALO, 4.5);
  stroke(context, unknown, colour, 2.5);
  context.setLineDash([]);
  context.globalAlpha = style.active ? 1 : 0.6;
  if (style.handles) {
    const shown = handlesAmong(points, style);
    points.forEach((point, index) => shown(point, index) && drawHandle(context, colour, point, handleStyle(index, style)));
    drawInsertion(context, colour, points, style);
  }
  context.restore();
}

/** Handles nearer to each other than this, CSS px, hide the edge that they are on. */
const DENSE = 14;
/** Then those around the pointer are shown. */
const ROUND_POINTER = 48;

/** Which points get a handle: all of a sparse outline, of a dense one those that the hand is near to. */
function handlesAmong(points: readonly CanvasPoint[], { closed, selected, pointer }: OutlineStyle) {
  const length = points.reduce((sum, point, index) => sum + (index > 0 ? distance(point, points[index - 1]!) : 0), 0);
  if (length >= DENSE * (points.length - 1)) return () => true;
  return (point: CanvasPoint, index: number) =>
    index === selected || (index === 0 && !closed) || (pointer !== null && distance(point, pointer) <= ROUND_POINTER);
}

/** The outline's sides, in a path for what is known and one for what is not. */
function paths(points: readonly CanvasPoint[], { closed, unknownSides }: OutlineStyle) {
  const known = new Path2D();
  const unknown = new Path2D();
  if (unknownSides.length === 0) {
    for (const { x, y } of points) known.lineTo(x, y);
    if (closed) known.closePath();
    return { known, unknown };
  }
  const marked = new Set(unknownSides);
  points.forEach((from, side) => {
    const to = points[side + 1] ?? (closed ? points[0] : undefined);
    if (!to) return;
    const path = marked.has(side) ? unknown : known;
    path.moveTo(from.x, from.y);
    path.lineTo(to.x, to.y);
  });
  return { known, unknown };
}

function handleStyle(index: number, { hit, selected, closed }: OutlineStyle): HandleStyle {
  const hovered = hit.kind === 'vertex' && hit.index === index;
  // The first point of a draft is where it closes.
  const first = index === 0 && !closed;
  return { radius: hovered || first ? 5.5 : 4, filled: index === selected, hovered };
}

interface HandleStyle {
  readonly radius: number;
  readonly filled: boolean;
  readonly hovered: boolean;
}

/** The widest handle with its halo fits, CSS px. */
const HANDLE_SIDE = 16;
/** Drawn once and copied from then on: an outline has dozens, and circles are dear without a graphics card. */
const handles = new Map<string, HTMLCanvasElement>();

function drawHandle(context: Context, colour: string, { x, y }: CanvasPoint, style: HandleStyle): void {
  const ratio = window.devicePixelRatio || 1;
  const key = [colour, style.radius, style.filled, style.hovered, ratio].join();
  const handle = handles.get(key) ?? paintHandle(colour, style, ratio);
  handles.set(key, handle);
  const onPixels = (at: number) => Math.round((at - HANDLE_SIDE / 2) * ratio) / ratio;
  context.drawImage(handle, onPixels(x), onPixels(y), HANDLE_SIDE, HANDLE_SIDE);
}

function paintHandle(colour: string, { radius, filled, hovered }: HandleStyle, ratio: number): HTMLCanvasElement {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = Math.ceil(HANDLE_SIDE * ratio);
  const context = canvas.getContext('2d');
  if (!context) return canvas;
  context.scale(ratio, ratio);
  context.arc(HANDLE_SIDE / 2, HANDLE_SIDE / 2, radius, 0, TAU);
  context.fillStyle = filled ? colour : 'rgb(20 22 24 / 0.85)';
  context.fill();
  context.lineWidth = 3;
  context.strokeStyle = HALO;
  context.stroke();
  context.lineWidth = 1.5;
  context.strokeStyle = hovered || filled ? '#ffffff' : colour;
  context.stroke();
  return canvas;
}

/** A faint handle where a click on the edge would insert a point. */
function drawInsertion(context: Context, colour: string, points: readonly CanvasPoint[], { hit, closed }: OutlineStyle): void {
  if (hit.kind !== 'edge' || !closed) return;
  const before = points[hit.before % points.length];
  const after = points[hit.before - 1];
  if (!before || !after) return;
  context.beginPath();
  context.moveTo(after.x, after.y);
  context.lineTo(before.x, before.y);
  context.lineWidth = 3;
  context.strokeStyle = colour;
  context.stroke();
}

export function drawRubberBand(context: Context, component: ComponentName, from: CanvasPoint, to: CanvasPoint): void {
  const path = new Path2D();
  path.moveTo(from.x, from.y);
  path.lineTo(to.x, to.y);
  context.save();
  context.setLineDash([5, 4]);
  stroke(context, path, HALO, 2.5);
  stroke(context, path, COMPONENT_COLOURS[component].css, 1);
  context.restore();
}

function stroke(context: Context, path: Path2D, colour: string, width: number): void {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke(path);
}
