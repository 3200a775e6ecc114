import { referencePose } from '../document/reference';
import type { State } from '../document/store';
import { bare } from '../document/hand_poses';
import { type Candidate, cellOf, type FrameEntry, type Outline } from '../document/types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { cameraOf } from '../results/keys';
import type { Studio } from '../films/studio';
import { canvasPoint, type CanvasPoint } from '../geometry/points';
import { canvasFromFrame, type Size, type Viewport } from '../geometry/viewport';
import { centreOf, handleAt, knobs, type Motion, RING } from '../interaction/adjust';
import type { HandSituation } from '../interaction/hand_situation';
import { COMPONENT_COLOURS, REFERENCE_COLOUR } from '../controls/colours';
import { OverlayLayer } from './layers';

type Context = CanvasRenderingContext2D;

const HALO = 'rgb(0 0 0 / 0.55)';
const TAU = 2 * Math.PI;

/** What lies over frame and outlines when somebody asks for it: other frames' outlines, the other set of poses, handles. */

// --- Outlines of the frames before and after ---------------------------------------------------------------------------

/** The frame before is dashed, the one after dotted. */
const GHOSTS = [
  { step: -1, dash: [9, 5] },
  { step: 1, dash: [2, 4] },
] as const;

export function drawGhosts(context: Context, state: State, view: Viewport): void {
  const { component, frameIndex, seeing } = state.ui;
  const { present: doc } = state.history;
  if (!seeing.ghosts) return;
  for (const { step, dash } of GHOSTS) {
    const { outline } = cellOf(doc, doc.frames[frameIndex + step]?.id, component);
    if (outline) drawGhost(context, view, component, outline, dash);
  }
}

function drawGhost(context: Context, view: Viewport, component: ComponentName, { points, closed }: Outline, dash: readonly number[]): void {
  const path = new Path2D();
  for (const point of points) {
    const { x, y } = canvasFromFrame(view, point);
    path.lineTo(x, y);
  }
  if (closed) path.closePath();
  context.save();
  context.globalAlpha = 0.6;
  context.setLineDash([...dash]);
  context.strokeStyle = COMPONENT_COLOURS[component].light;
  context.lineWidth = 1.25;
  context.stroke(path);
  context.restore();
}

// --- Clicks that are being answered -------------------------------------------------------------------------------------

/** CSS pixels around the place of a click. */
const CLICK_RING = 12;
/** What is shown of a ring before anything is done. */
const BEGUN = 0.06;

/** How far the answer to each click on the frame is, where somebody clicked and looks. */
export function drawClicks(context: Context, { ui: { jobs } }: State, frame: FrameEntry, view: Viewport): void {
  for (const { at, place, done, total } of jobs) {
    if (!at || place?.frameId !== frame.id) continue;
    const { x, y } = canvasFromFrame(view, at);
    const ring = (part: number, colour: string, width: number) => {
      context.beginPath();
      context.arc(x, y, CLICK_RING, -TAU / 4, TAU * (part - 1 / 4));
      context.lineWidth = width;
      context.strokeStyle = colour;
      context.stroke();
    };
    ring(1, HALO, 5);
    ring(Math.max(BEGUN, total > 0 ? done / total : 0), COMPONENT_COLOURS[place.component].light, 3);
  }
}

// --- The set to compare with -------------------------------------------------------------------------------------------

export class ReferenceLayers {
  readonly #layers = COMPONENT_NAMES.map((component) => new OverlayLayer(component));
  /** A layer draws anew when its candidate is another one. */
  readonly #candidates = new WeakMap<PoseNumbers, Candidate>();

  draw(context: Context, state: State, studio: Studio, frame: FrameEntry, view: Viewport): void {
    const { present: doc } = state.history;
    if (!state.ui.seeing.comparing || !doc.reference) return;
    for (const layer of this.#layers) {
      const { component } = layer;
      const { model } = doc.components[component];
      const held = model && studio.meshOf(model.sha256) ? model.sha256 : null;
      const pose = referencePose(doc, { frameId: frame.id, component });
      layer.update(studio, cameraOf(doc, frame), held, pose && this.#candidateOf(pose));
      if (layer.border) strokeBorder(context, view, layer.border, REFERENCE_COLOUR, [2, 4]);
    }
  }

  #candidateOf(pose: PoseNumbers): Candidate {
    const known = this.#candidates.get(pose);
    if (known) return known;
    const candidate = bare(pose);
    this.#candidates.set(pose, candidate);
    return candidate;
  }
}

/** A border in frame coordinates, as a thin line of the screen. */
export function strokeBorder(context: Context, view: Viewport, border: Path2D, colour: string, dash: readonly number[] = []): void {
  context.save();
  context.translate(view.left, view.top);
  context.scale(view.scale, view.scale);
  context.lineJoin = 'round';
  const px = 1 / view.scale;
  for (const [style, width] of [[HALO, 3.5], [colour, 1.75]] as const) {
    context.strokeStyle = style;
    context.lineWidth = width * px;
    context.setLineDash(dash.map((length) => length * px));
    context.stroke(border);
  }
  context.restore();
}

// --- Handles of a model that is adjusted by hand -----------------------------------------------------------------------

const KNOB = 7;

/** What of the handles lies under the pointer, and the handles themselves. */
export function drawHandles(context: Context, situation: HandSituation, view: Viewport, component: ComponentName, pointer: CanvasPoint | null): Motion | null {
  const centre = centreOf(situation, view);
  if (!centre) return null;
  const hovered = pointer && handleAt(situation, view, pointer);
  const { css, light } = COMPONENT_COLOURS[component];
  context.save();
  const ring = new Path2D();
  ring.arc(centre.x, centre.y, RING, 0, TAU);
  line(context, ring, hovered === 'turn' ? light : css, hovered === 'turn' ? 2.5 : 1.5);
  const places = knobs(centre);
  line(context, round(places.turn), hovered === 'turn' ? '#ffffff' : css, 2);
  line(context, diamond(places.depth), hovered === 'depth' ? '#ffffff' : css, 2);
  line(context, cross(places.tilt), hovered === 'tilt' ? '#ffffff' : css, 2);
  context.restore();
  return hovered;
}

function line(context: Context, path: Path2D, colour: string, width: number): void {
  for (const [style, wide] of [[HALO, width + 2], [colour, width]] as const) {
    context.strokeStyle = style;
    context.lineWidth = wide;
    context.stroke(path);
  }
}

function round({ x, y }: CanvasPoint): Path2D {
  const path = new Path2D();
  path.arc(x, y, KNOB, 0, TAU);
  return path;
}

function diamond({ x, y }: CanvasPoint): Path2D {
  return new Path2D(`M${x} ${y - KNOB}l${KNOB} ${KNOB}l${-KNOB} ${KNOB}l${-KNOB} ${-KNOB}z`);
}

function cross({ x, y }: CanvasPoint): Path2D {
  const path = new Path2D(`M${x - KNOB} ${y}h${2 * KNOB}M${x} ${y - KNOB}v${2 * KNOB}`);
  path.addPath(round(canvasPoint(x, y)));
  return path;
}

// --- Magnifier ----------------------------------------------------------------------------------------------------------

export const MAGNIFICATION = 4;
const LENS = 168;
/** From the pointer to the lens: neither the pointer nor what it works at is covered. */
const AWAY = 36;

export interface Lens {
  readonly left: number;
  readonly top: number;
  readonly size: number;
  readonly centre: CanvasPoint;
  /** What lies under the pointer lies in the middle of the lens. */
  readonly view: Viewport;
}

/** Above and to the right of the pointer; on the other side where the canvas ends. */
export function lensAt(pointer: CanvasPoint, view: Viewport, canvas: Size): Lens {
  const beside = (at: number, room: number, before: boolean) => {
    const after = at + AWAY;
    const ahead = at - AWAY - LENS;
    const first = before ? ahead : after;
    const other = before ? after : ahead;
    return first >= 0 && first + LENS <= room ? first : other;
  };
  const left = beside(pointer.x, canvas.width, false);
  const top = beside(pointer.y, canvas.height, true);
  const centre = canvasPoint(left + LENS / 2, top + LENS / 2);
  const moved = (middle: number, at: number, origin: number) => middle - (at - origin) * MAGNIFICATION;
  return {
    left,
    top,
    size: LENS,
    centre,
    view: { scale: view.scale * MAGNIFICATION, left: moved(centre.x, pointer.x, view.left), top: moved(centre.y, pointer.y, view.top) },
  };
}

/** The lens with whatever `paint` draws in it, and a crosshair that leaves the very middle free. */
export function drawLens(context: Context, lens: Lens, paint: () => void): void {
  const { left, top, size, centre } = lens;
  const frame = new Path2D();
  frame.roundRect(left, top, size, size, 8);
  context.save();
  context.save();
  context.clip(frame);
  context.fillStyle = '#0b0c0d';
  context.fillRect(left, top, size, size);
  paint();
  context.restore();
  line(context, frame, '#d8dbde', 1);
  const gap = 6;
  const hair = new Path2D(
    `M${left} ${centre.y}H${centre.x - gap}M${centre.x + gap} ${centre.y}H${left + size}` +
      `M${centre.x} ${top}V${centre.y - gap}M${centre.x} ${centre.y + gap}V${top + size}`,
  );
  context.globalAlpha = 0.75;
  line(context, hair, '#ffffff', 1);
  context.restore();
}

/** Twice as opaque as a fill: light and shade have to be seen. */
export function drawShaded(context: Context, picture: HTMLCanvasElement, { width, height }: Size, opacity: number): void {
  context.save();
  context.globalAlpha = Math.min(1, 2 * opacity);
  context.drawImage(picture, 0, 0, width, height);
  context.restore();
}
