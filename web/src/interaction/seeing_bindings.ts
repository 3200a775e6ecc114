import type { FilmLook, OverlayLook } from '../document/seeing';
import type { Binding, KeyInput } from './bindings';

/** Keys of how things are shown. */
export type SeeingAction =
  | { readonly name: 'film'; readonly look: FilmLook }
  | { readonly name: 'overlay'; readonly look: OverlayLook }
  | { readonly name: 'magnifier' | 'ghosts' | 'scale-bar' | 'compare' | 'view-sheet' };

interface SeeingBinding extends Omit<Binding, 'action' | 'group'> {
  readonly action: SeeingAction;
}

function binding(key: string, does: string, action: SeeingAction): SeeingBinding {
  const matches = (input: KeyInput) => !input.ctrl && !input.shift && !input.alt && input.key.toLowerCase() === key;
  return { shown: [key.toUpperCase()], does, matches, action };
}

export const SEEING_BINDINGS: readonly SeeingBinding[] = [
  binding('1', 'The film as it is', { name: 'film', look: 'original' }),
  binding('2', 'The film inverted', { name: 'film', look: 'inverted' }),
  binding('3', 'The film’s edges', { name: 'film', look: 'edges' }),
  binding('4', 'The film with its contrast equalised', { name: 'film', look: 'equalised' }),
  binding('5', 'The model as an outline', { name: 'overlay', look: 'outline' }),
  binding('6', 'The model as a translucent fill', { name: 'overlay', look: 'fill' }),
  binding('7', 'The model shaded', { name: 'overlay', look: 'shaded' }),
  binding('z', 'Magnifier at the cursor', { name: 'magnifier' }),
  binding('g', 'Outlines of the frames before and after', { name: 'ghosts' }),
  binding('q', 'Compare with the other set of poses', { name: 'compare' }),
  binding('8', 'Scale bar', { name: 'scale-bar' }),
  binding('9', 'All of how things are shown', { name: 'view-sheet' }),
];

export function seeingActionFor(key: KeyInput): SeeingAction | null {
  return SEEING_BINDINGS.find((binding) => binding.matches(key))?.action ?? null;
}

/** The key of an action, as it is shown beside its control. */
export function seeingKey(action: SeeingAction): string {
  const same = (other: SeeingAction) => JSON.stringify(other) === JSON.stringify(action);
  return SEEING_BINDINGS.find((binding) => same(binding.action))?.shown[0] ?? '';
}
