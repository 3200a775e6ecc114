import type { Preprocessing, OverlayStyle } from '../terms/seeing';
import type { Binding, KeyInput } from './bindings';
import { texts } from '../texts/texts';

/** Keys of how things are shown. */
export type SeeingAction =
  | { readonly name: 'preprocessing'; readonly preprocessing: Preprocessing }
  | { readonly name: 'overlay'; readonly style: OverlayStyle }
  | { readonly name: 'magnifier' | 'ghosts' | 'scale-bar' | 'compare' | 'view-sheet' };

interface SeeingBinding extends Omit<Binding, 'action' | 'group'> {
  readonly action: SeeingAction;
}

function binding(key: string, does: string, action: SeeingAction): SeeingBinding {
  const matches = (input: KeyInput) => !input.ctrl && !input.shift && !input.alt && input.key.toLowerCase() === key;
  return { shown: [key.toUpperCase()], does, matches, action };
}

export const SEEING_BINDINGS: readonly SeeingBinding[] = [
  binding('1', texts.keys.seeing.original, { name: 'preprocessing', preprocessing: 'original' }),
  binding('2', texts.keys.seeing.inverted, { name: 'preprocessing', preprocessing: 'inverted' }),
  binding('3', texts.keys.seeing.edges, { name: 'preprocessing', preprocessing: 'edges' }),
  binding('4', texts.keys.seeing.equalised, { name: 'preprocessing', preprocessing: 'equalised' }),
  binding('5', texts.keys.seeing.outline, { name: 'overlay', style: 'outline' }),
  binding('6', texts.keys.seeing.fill, { name: 'overlay', style: 'fill' }),
  binding('7', texts.keys.seeing.shaded, { name: 'overlay', style: 'shaded' }),
  binding('z', texts.keys.seeing.magnifier, { name: 'magnifier' }),
  binding('g', texts.keys.seeing.ghosts, { name: 'ghosts' }),
  binding('q', texts.keys.seeing.compare, { name: 'compare' }),
  binding('8', texts.keys.seeing.scaleBar, { name: 'scale-bar' }),
  binding('9', texts.keys.seeing.sheet, { name: 'view-sheet' }),
];

export function seeingActionFor(key: KeyInput): SeeingAction | null {
  return SEEING_BINDINGS.find((binding) => binding.matches(key))?.action ?? null;
}

/** The key of an action, as it is shown beside its control. */
export function seeingKey(action: SeeingAction): string {
  const same = (other: SeeingAction) => JSON.stringify(other) === JSON.stringify(action);
  return SEEING_BINDINGS.find((binding) => same(binding.action))?.shown[0] ?? '';
}
