import type { GridAxis, LandscapeFacts } from '../workers/protocol/by_hand';
import { grouped } from '../texts/numbers';
import { texts } from '../texts/texts';

/** A view by its places on both axes of the grid. */
export interface LandscapeCell {
  readonly x: number;
  readonly y: number;
}

export function degreesOf({ first, step }: GridAxis, place: number): string {
  return inDegrees(first + step * place);
}

/** Are the last views neighbours of the first? */
export function goesAround({ step, count }: GridAxis): boolean {
  return Math.abs(step * count - 360) < step / 2;
}

function inDegrees(value: number): string {
  return `${(Math.round(10 * value) / 10).toString().replace('-', '\u2212')}°`;
}

/** The best and how many rivals come near it, in words. */
export function summary({ minima, scores }: LandscapeFacts): string {
  const words = texts.seeing.landscape;
  const [best, ...others] = minima;
  if (!best) return '';
  const near = others.filter(({ unmatched }) => unmatched <= 2 * best.unmatched).length;
  const rivals = near > 0 ? `, ${words.rivals(near)}` : '';
  const range = words.scale(grouped(Math.min(...scores)), grouped(Math.max(...scores)));
  return `${words.best(inDegrees(best.x), inDegrees(best.y))}${rivals}; ${range}`;
}
