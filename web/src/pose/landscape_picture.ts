import type { LandscapeCell } from '../results/landscape';
import type { GridAxis, LandscapeFacts, Minimum } from '../workers/protocol/by_hand';

/**
 * Scores as shades: few unmatched pixels bright. The scale is that of square roots, so that the valley has as many shades
 * as the slopes. y rotations run to the right, x rotations down.
 */
export function paintLandscape(context: CanvasRenderingContext2D, facts: LandscapeFacts, cursor: LandscapeCell): void {
  const { canvas } = context;
  const [width, height] = [canvas.width / facts.y.count, canvas.height / facts.x.count];
  const shade = shadesOf(facts.scores);
  for (let y = 0; y < facts.y.count; y++) {
    for (let x = 0; x < facts.x.count; x++) {
      context.fillStyle = shade(facts.scores[y * facts.x.count + x] ?? 0);
      context.fillRect(y * width, x * height, width, height);
    }
  }
  facts.minima.forEach((minimum, rank) => mark(context, facts, minimum, rank));
  context.lineWidth = 1;
  context.strokeStyle = '#ffffff';
  context.strokeRect(cursor.y * width + 0.5, cursor.x * height + 0.5, width - 1, height - 1);
}

/** The best is a ring with a dot, rivals are rings; dark under light, to be seen on any shade. */
function mark(context: CanvasRenderingContext2D, facts: LandscapeFacts, { x, y }: Minimum, rank: number): void {
  const { canvas } = context;
  const place = (value: number, { first, step, count }: GridAxis, length: number) => (((value - first) / step + 0.5) * length) / count;
  const [across, down] = [place(y, facts.y, canvas.width), place(x, facts.x, canvas.height)];
  for (const [style, width] of [['#000000', 4], [rank === 0 ? '#ffffff' : '#e69f00', 1.75]] as const) {
    context.beginPath();
    context.arc(across, down, rank === 0 ? 8 : 6, 0, 2 * Math.PI);
    context.strokeStyle = style;
    context.lineWidth = width;
    context.stroke();
  }
  if (rank > 0) return;
  context.beginPath();
  context.arc(across, down, 2, 0, 2 * Math.PI);
  context.fillStyle = '#000000';
  context.fill();
}

/** From dark blue through grey to light yellow, as in "cividis": told apart by everybody, and in grey. */
const STOPS = [
  [0, 32, 77],
  [66, 77, 108],
  [124, 123, 120],
  [187, 175, 113],
  [255, 234, 70],
] as const;

function shadesOf(scores: ArrayLike<number>): (score: number) => string {
  const all = Array.from(scores);
  const [least, most] = [Math.sqrt(Math.min(...all)), Math.sqrt(Math.max(...all))];
  return (score) => colourAt(1 - (Math.sqrt(score) - least) / Math.max(1e-9, most - least));
}

function colourAt(fraction: number): string {
  const at = Math.min(1, Math.max(0, fraction)) * (STOPS.length - 1);
  const [low, high] = [STOPS[Math.floor(at)] ?? STOPS[0], STOPS[Math.ceil(at)] ?? STOPS[0]];
  const mix = (channel: 0 | 1 | 2) => Math.round(low[channel] + (high[channel] - low[channel]) * (at % 1));
  return `rgb(${mix(0)} ${mix(1)} ${mix(2)})`;
}

/** The view under the pointer. */
export function cellAt(facts: LandscapeFacts, canvas: HTMLCanvasElement, { offsetX, offsetY }: MouseEvent): LandscapeCell {
  const at = (offset: number, length: number, count: number) => Math.min(count - 1, Math.max(0, Math.floor((offset / length) * count)));
  return { y: at(offsetX, canvas.clientWidth, facts.y.count), x: at(offsetY, canvas.clientHeight, facts.x.count) };
}
