import type { PoseNumbers } from '../document/types';
import type { Binding, KeyInput } from './bindings';

/** Keys while the model is adjusted by hand: arrows as in JointTrack. They come before the keys of the page. */
export type HandAction =
  | { readonly name: 'nudge'; readonly field: keyof PoseNumbers; readonly sign: 1 | -1 }
  | { readonly name: 'coarse' | 'fine' | 'refine-from-here' };

interface HandBinding extends Omit<Binding, 'action' | 'group'> {
  readonly action: HandAction;
}

const nudge = (shown: string, does: string, held: Held, key: string, field: keyof PoseNumbers, sign: 1 | -1): HandBinding => ({
  shown: [shown],
  does,
  matches: (input) => isHeld(input, held) && input.key === key,
  action: { name: 'nudge', field, sign },
});

type Held = 'nothing' | 'ctrl' | 'shift';

function isHeld({ ctrl, shift, alt }: KeyInput, held: Held): boolean {
  return !alt && ctrl === (held === 'ctrl') && shift === (held === 'shift');
}

export const HAND_BINDINGS: readonly HandBinding[] = [
  nudge('←', 'Left: x less', 'nothing', 'ArrowLeft', 'x', -1),
  nudge('→', 'Right: x more', 'nothing', 'ArrowRight', 'x', 1),
  nudge('↑', 'Up: y more', 'nothing', 'ArrowUp', 'y', 1),
  nudge('↓', 'Down: y less', 'nothing', 'ArrowDown', 'y', -1),
  nudge('Ctrl + ↑', 'Nearer: z more', 'ctrl', 'ArrowUp', 'z', 1),
  nudge('Ctrl + ↓', 'Farther: z less', 'ctrl', 'ArrowDown', 'z', -1),
  nudge('Ctrl + ←', 'Turn against the clock: z rotation more', 'ctrl', 'ArrowLeft', 'zRot', 1),
  nudge('Ctrl + →', 'Turn with the clock: z rotation less', 'ctrl', 'ArrowRight', 'zRot', -1),
  nudge('Shift + ↑', 'x rotation less', 'shift', 'ArrowUp', 'xRot', -1),
  nudge('Shift + ↓', 'x rotation more', 'shift', 'ArrowDown', 'xRot', 1),
  nudge('Shift + ←', 'y rotation less', 'shift', 'ArrowLeft', 'yRot', -1),
  nudge('Shift + →', 'y rotation more', 'shift', 'ArrowRight', 'yRot', 1),
  {
    shown: ['+'],
    does: 'Coarse steps',
    matches: ({ key, ctrl, alt }) => !ctrl && !alt && (key === '+' || key === '='),
    action: { name: 'coarse' },
  },
  {
    shown: ['-'],
    does: 'Fine steps',
    matches: ({ key, ctrl, alt }) => !ctrl && !alt && (key === '-' || key === '_'),
    action: { name: 'fine' },
  },
  {
    shown: ['Enter'],
    does: 'Refine from here; where there is no pose, place the model',
    matches: (input) => isHeld(input, 'nothing') && input.key === 'Enter',
    action: { name: 'refine-from-here' },
  },
];

/** What the mouse does meanwhile; the sheet of keys tells it. */
export const HAND_MOUSE: readonly { readonly shown: readonly string[]; readonly does: string }[] = [
  { shown: ['Drag'], does: 'Move in the image plane' },
  { shown: ['Shift + drag'], does: 'Tilt; also by the knob in the middle' },
  { shown: ['Ctrl + drag'], does: 'Turn in the plane; also by the ring' },
  { shown: ['Ctrl + Shift + drag'], does: 'Nearer and farther; also by the knob below' },
];

export function handActionFor(key: KeyInput): HandAction | null {
  return HAND_BINDINGS.find((binding) => binding.matches(key))?.action ?? null;
}
