import { canvasPoint, framePoint, type CanvasPoint, type FramePoint } from './points';

/** How the frame lies on the canvas: `canvas = frame * scale + (left, top)`, in CSS pixels. */
export interface Viewport {
  readonly scale: number;
  readonly left: number;
  readonly top: number;
}

export interface Size {
  readonly width: number;
  readonly height: number;
}

const SMALLEST_SCALE = 0.05;
const LARGEST_SCALE = 64;
const MARGIN = 12;

export function canvasFromFrame(view: Viewport, p: FramePoint): CanvasPoint {
  return canvasPoint(p.column * view.scale + view.left, p.row * view.scale + view.top);
}

export function frameFromCanvas(view: Viewport, p: CanvasPoint): FramePoint {
  return framePoint((p.x - view.left) / view.scale, (p.y - view.top) / view.scale);
}

/** The whole frame, centred, as large as it can be. */
export function fit(frame: Size, canvas: Size): Viewport {
  const room = (length: number) => Math.max(1, length - 2 * MARGIN);
  const scale = clampScale(Math.min(room(canvas.width) / frame.width, room(canvas.height) / frame.height));
  return {
    scale,
    left: (canvas.width - frame.width * scale) / 2,
    top: (canvas.height - frame.height * scale) / 2,
  };
}

/** Zooms by a factor; what lies under `at` stays there. */
export function zoomAt(view: Viewport, at: CanvasPoint, factor: number): Viewport {
  const scale = clampScale(view.scale * factor);
  const ratio = scale / view.scale;
  return {
    scale,
    left: at.x - (at.x - view.left) * ratio,
    top: at.y - (at.y - view.top) * ratio,
  };
}

export function pan(view: Viewport, dx: number, dy: number): Viewport {
  return { scale: view.scale, left: view.left + dx, top: view.top + dy };
}

/** After a resize of the canvas: what was in its middle stays in its middle. */
export function recentre(view: Viewport, before: Size, after: Size): Viewport {
  return pan(view, (after.width - before.width) / 2, (after.height - before.height) / 2);
}

function clampScale(scale: number): number {
  return Math.min(LARGEST_SCALE, Math.max(SMALLEST_SCALE, scale));
}
