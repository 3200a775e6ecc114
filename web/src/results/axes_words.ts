import type { Axes, Doc } from '../document/types';
import { type Directions, opposite, wordOf, wordsOf } from '../geometry/axes';
import type { Vector } from '../geometry/pose_motion';
import type { ComponentName } from '../terms/component';
import { later } from '../texts/later';

type Side = Doc['side'];

/** Anterior, superior, and lateral where the side of the body tells which way that is, else right. */
export function namedDirections(directions: Directions, side: Side): readonly { readonly name: string; readonly direction: Vector }[] {
  const [anterior, superior, right] = directions;
  const { arrows, lateral, right: toTheRight } = later.axes;
  return [
    { name: arrows.anterior, direction: anterior },
    { name: arrows.superior, direction: superior },
    side === 'unknown' ? { name: toTheRight, direction: right } : { name: lateral, direction: side === 'right' ? right : opposite(right) },
  ];
}

/** Arrows with their names; a name that may be wrong asks. None where the shape tells lines alone. */
export function namedArrows({ directions, told }: Axes, side: Side): readonly { readonly name: string; readonly direction: Vector }[] {
  if (told !== 'all' && told !== 'not the front') return [];
  const isSure = (name: string) => told === 'all' || name === later.axes.arrows.superior;
  return namedDirections(directions, side).map(({ name, direction }) => ({ name: isSure(name) ? name : later.axes.perhaps(name), direction }));
}

/** "x anterior, y superior, -z lateral". */
export function axesInWords(directions: Directions, side: Side): string {
  const named = namedDirections(directions, side);
  const third = named[2]!.name;
  const [anterior = '', superior = '', other = ''] = named.map(({ direction }) => shownWord(direction));
  return (wordsOf(directions) ? later.axes.words : later.axes.turned)(anterior, superior, other, third);
}

function shownWord(direction: Vector): string {
  const number = (value: number) => value.toFixed(2).replace('-', '\u2212');
  return wordOf(direction)?.replace('-', '\u2212') ?? `(${direction.map(number).join(', ')})`;
}

/** A sentence or two: what the axes are, who said so, and what is not known of them. */
export function axesSentence(axes: Axes | null, component: ComponentName, side: Side, hasModel: boolean): string {
  const words = later.axes;
  if (!axes) return hasModel ? words.finding : words.assumed;
  switch (axes.told) {
    case 'all':
      return words.sentence(axesInWords(axes.directions, side), words.from[axes.from]);
    case 'not the front':
      return words.notTheFront(axesInWords(axes.directions, side));
    case 'no signs':
      return words.unsigned[component];
    case 'nothing':
      return words.nothing;
  }
}
