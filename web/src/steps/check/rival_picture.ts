import { COMPONENT_COLOURS } from '../../controls/colours';
import type { FrameEntry, GreyWindow } from '../../document/types';
import type { Studio } from '../../films/studio';
import type { PoseNumbers } from '../../geometry/pose_numbers';
import type { ComponentName } from '../../terms/component';
import type { CameraInput } from '../../workers/protocol/camera';

/** What a rival is drawn with. */
export interface RivalScene {
  readonly frame: FrameEntry;
  readonly camera: CameraInput;
  readonly component: ComponentName;
  /** SHA-256. */
  readonly model: string;
  readonly window: GreyWindow;
}

/** Around the model, as a part of its size. */
const MARGIN = 0.2;

/** Draws the part of the frame that a model covers, with its border there, and thinly that of the pose `beside`. Nothing where it cannot be drawn. */
export function drawRival(canvas: HTMLCanvasElement, studio: Studio, scene: RivalScene, pose: PoseNumbers, beside: PoseNumbers | null): void {
  const context = canvas.getContext('2d');
  const { frame, component, window } = scene;
  if (!context || !studio.holdsFrame(frame.id)) return;
  const whole = scratch(frame);
  if (!whole) return;
  const { light } = COMPONENT_COLOURS[component];
  const border = borderAt(studio, scene, whole, pose);
  const other = beside ? borderAt(studio, scene, whole, beside) : [];
  if (border.length === 0) return;
  const [left, top, size] = squareAround(border);
  studio.paintFrame(whole, frame.id, window);
  const scale = canvas.width / size;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.setTransform(scale, 0, 0, scale, -left * scale, -top * scale);
  context.drawImage(whole.canvas, 0, 0);
  drawBorder(context, other, 1.5 / scale, BESIDE);
  drawBorder(context, border, 3 / scale, light);
}

/** Where something may lie on the frame. */
export type Corner = `at-${'left' | 'right'} at-${'top' | 'bottom'}`;

const CORNERS: readonly Corner[] = ['at-left at-top', 'at-right at-top', 'at-left at-bottom', 'at-right at-bottom'];

/** The corner of the frame that models at these poses take least of, by their outlines; the first of equal ones. */
export function cornerBeside(studio: Studio, drawn: readonly { readonly scene: RivalScene; readonly pose: PoseNumbers }[]): Corner {
  const taken = [0, 0, 0, 0];
  for (const { scene, pose } of drawn) {
    const { frame } = scene;
    const whole = studio.holdsFrame(frame.id) ? scratch(frame) : null;
    const border = whole ? borderAt(studio, scene, whole, pose) : [];
    for (let at = 0; at + 1 < border.length; at += 2) {
      const corner = Number(border[at]! >= frame.width / 2) + 2 * Number(border[at + 1]! >= frame.height / 2);
      taken[corner]! += 1;
    }
  }
  return CORNERS[taken.indexOf(Math.min(...taken))]!;
}

/** Columns and rows by turns; none where the model cannot be drawn. */
function borderAt(studio: Studio, { model, camera, component }: RivalScene, whole: NonNullable<ReturnType<typeof scratch>>, at: PoseNumbers): readonly number[] {
  return Array.from(studio.paintSilhouette(() => whole, model, camera, at, COMPONENT_COLOURS[component].rgb)?.border ?? []);
}

/** What differs from the pose that is chosen is what is to be looked at. */
const BESIDE = '#fff';

function drawBorder(context: CanvasRenderingContext2D, border: readonly number[], width: number, colour: string): void {
  context.beginPath();
  for (let at = 0; at + 1 < border.length; at += 2) context.lineTo(border[at]!, border[at + 1]!);
  context.closePath();
  context.lineWidth = width;
  context.strokeStyle = colour;
  context.stroke();
}

/** Upper left corner and side of a square that holds columns and rows by turns. */
function squareAround(border: readonly number[]): readonly [number, number, number] {
  const [columns, rows] = [0, 1].map((axis) => border.filter((_, at) => at % 2 === axis)) as [number[], number[]];
  const ends = [columns, rows].map((all) => [all.reduce((a, b) => Math.min(a, b), Infinity), all.reduce((a, b) => Math.max(a, b), -Infinity)] as const);
  const [[left, right], [top, bottom]] = ends as [readonly [number, number], readonly [number, number]];
  const size = (1 + 2 * MARGIN) * Math.max(right - left, bottom - top, 1);
  return [(left + right - size) / 2, (top + bottom - size) / 2, size];
}

let shared: HTMLCanvasElement | null = null;

function scratch({ width, height }: FrameEntry): CanvasRenderingContext2D | null {
  shared ??= document.createElement('canvas');
  if (shared.width !== width) shared.width = width;
  if (shared.height !== height) shared.height = height;
  return shared.getContext('2d');
}
