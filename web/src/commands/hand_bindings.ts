import type { PoseNumbers } from '../geometry/pose_numbers';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';
import type { Motion } from '../interaction/adjust';
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
  nudge('←', texts.keys.hand.left, 'nothing', 'ArrowLeft', 'x', -1),
  nudge('→', texts.keys.hand.right, 'nothing', 'ArrowRight', 'x', 1),
  nudge('↑', texts.keys.hand.up, 'nothing', 'ArrowUp', 'y', 1),
  nudge('↓', texts.keys.hand.down, 'nothing', 'ArrowDown', 'y', -1),
  nudge('Ctrl + ↑', texts.keys.hand.nearer, 'ctrl', 'ArrowUp', 'z', 1),
  nudge('Ctrl + ↓', texts.keys.hand.farther, 'ctrl', 'ArrowDown', 'z', -1),
  nudge('Ctrl + ←', texts.keys.hand.againstClock, 'ctrl', 'ArrowLeft', 'zRot', 1),
  nudge('Ctrl + →', texts.keys.hand.withClock, 'ctrl', 'ArrowRight', 'zRot', -1),
  nudge('Shift + ↑', texts.keys.hand.xLess, 'shift', 'ArrowUp', 'xRot', -1),
  nudge('Shift + ↓', texts.keys.hand.xMore, 'shift', 'ArrowDown', 'xRot', 1),
  nudge('Shift + ←', texts.keys.hand.yLess, 'shift', 'ArrowLeft', 'yRot', -1),
  nudge('Shift + →', texts.keys.hand.yMore, 'shift', 'ArrowRight', 'yRot', 1),
  {
    shown: ['+'],
    does: texts.keys.hand.coarse,
    matches: ({ key, ctrl, alt }) => !ctrl && !alt && (key === '+' || key === '='),
    action: { name: 'coarse' },
  },
  {
    shown: ['-'],
    does: texts.keys.hand.fine,
    matches: ({ key, ctrl, alt }) => !ctrl && !alt && (key === '-' || key === '_'),
    action: { name: 'fine' },
  },
  {
    shown: ['Enter'],
    does: texts.keys.hand.refine,
    matches: (input) => isHeld(input, 'nothing') && input.key === 'Enter',
    action: { name: 'refine-from-here' },
  },
];

/** What the mouse does meanwhile; the sheet of keys tells it. */
export const HAND_MOUSE: readonly { readonly shown: readonly string[]; readonly does: string }[] = texts.keys.hand.mouse;

export function handActionFor(key: KeyInput): HandAction | null {
  return HAND_BINDINGS.find((binding) => binding.matches(key))?.action ?? null;
}

/** One line: what the next press does to the model. */
export function handHint(component: ComponentName, there: boolean, motion: Motion | null): string {
  const words = texts.hand.hints;
  return there ? words.over[motion ?? 'move'] : words.absent(texts.component[component]);
}
