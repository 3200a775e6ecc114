import { texts } from '../texts/texts';
import { TRACING_KEYS, TRACING_ROWS, type TracingCommand, type TracingKey } from './tracing_keys';
import { TOOLS } from '../interaction/tools';
import type { ToolName } from '../terms/tool';
import { WORK_KEYS, type WorkCommand, type WorkKey } from './work_keys';

/** What keys do. The sheet that `?` shows is made from this table, so the two cannot differ. */
export type Action =
  | { readonly name: 'tool'; readonly tool: ToolName }
  | { readonly name: 'tracing'; readonly command: TracingCommand }
  | { readonly name: 'work'; readonly command: WorkCommand }
  | {
      readonly name:
        | 'undo'
        | 'redo'
        | 'save'
        | 'open'
        | 'previous-frame'
        | 'next-frame'
        | 'other-component'
        | 'other-candidate'
        | 'close-outline'
        | 'delete-point'
        | 'delete-outline'
        | 'previous-point'
        | 'next-point'
        | 'toggle-unknown'
        | 'leave'
        | 'fit'
        | 'zoom-in'
        | 'zoom-out'
        | 'reset-window'
        | 'theme'
        | 'keys';
    };

export interface Binding {
  /** As shown on the sheet. */
  readonly shown: readonly string[];
  readonly does: string;
  readonly group: 'Tracing' | 'Shaping' | 'Seeing' | 'Working' | 'Mouse';
  readonly matches: (key: KeyInput) => boolean;
  /** Null: the sheet tells of it, something else does it. */
  readonly action: Action | null;
  /** With these tools alone, and before what the key means otherwise. */
  readonly tools?: readonly ToolName[] | undefined;
}

/** The part of a `KeyboardEvent` that matters. */
export interface KeyInput {
  readonly key: string;
  readonly ctrl: boolean;
  readonly shift: boolean;
  readonly alt: boolean;
}

export const BINDINGS: readonly Binding[] = [
  ...TRACING_KEYS.map(tracingKey),
  ...TRACING_ROWS.map(({ shown, does }): Binding => ({ group: 'Shaping', shown, does, matches: () => false, action: null })),
  ...TOOLS.map(({ name, key, title }) =>
    binding('Tracing', [key.toUpperCase()], title, plainly(key), { name: 'tool', tool: name }),
  ),
  binding('Tracing', ['Enter'], texts.keys.closeOutline, plainly('enter'), { name: 'close-outline' }),
  binding('Tracing', ['Delete', 'Backspace'], texts.keys.deletePoint, plainly('delete', 'backspace'), {
    name: 'delete-point',
  }),
  binding('Tracing', ['Shift + Delete'], texts.keys.deleteOutline, shifted('delete', 'backspace'), { name: 'delete-outline' }),
  binding('Tracing', [','], texts.keys.previousPoint, plainly(','), { name: 'previous-point' }),
  binding('Tracing', ['.'], texts.keys.nextPoint, plainly('.'), { name: 'next-point' }),
  binding('Tracing', ['U'], texts.keys.toggleUnknown, plainly('u'), {
    name: 'toggle-unknown',
  }),
  binding('Tracing', ['Esc'], texts.keys.leave, plainly('escape'), { name: 'leave' }),
  binding('Tracing', ['X'], texts.keys.otherCandidate, plainly('x'), { name: 'other-candidate' }),
  binding('Working', ['D', '←', 'Page Up'], texts.keys.previousFrame, plainly('d', 'pageup', 'arrowleft'), { name: 'previous-frame' }),
  binding('Working', ['F', '→', 'Page Down'], texts.keys.nextFrame, plainly('f', 'pagedown', 'arrowright'), { name: 'next-frame' }),
  binding('Working', ['C'], texts.keys.otherComponent, plainly('c'), { name: 'other-component' }),
  ...WORK_KEYS.map(workKey),
  told(['1', '2', '3'], texts.check.keys.take),
  told(['E'], texts.check.keys.edit),
  binding('Working', ['Ctrl + Z'], texts.keys.undo, (key) => key.ctrl && !key.shift && is(key, 'z'), { name: 'undo' }),
  binding(
    'Working',
    ['Ctrl + Y', 'Ctrl + Shift + Z'],
    texts.keys.redo,
    (key) => key.ctrl && (is(key, 'y') || (key.shift && is(key, 'z'))),
    { name: 'redo' },
  ),
  binding('Working', ['Ctrl + S'], texts.keys.save, (key) => key.ctrl && is(key, 's'), { name: 'save' }),
  binding('Working', ['Ctrl + O'], texts.keys.open, (key) => key.ctrl && is(key, 'o'), { name: 'open' }),
  binding('Working', ['?'], texts.keys.sheet, (key) => is(key, '?'), { name: 'keys' }),
  binding('Seeing', ['0'], texts.keys.fit, plainly('0'), { name: 'fit' }),
  binding('Seeing', ['+'], texts.keys.zoomIn, (key) => is(key, '+', '='), { name: 'zoom-in' }),
  binding('Seeing', ['-'], texts.keys.zoomOut, plainly('-'), { name: 'zoom-out' }),
  binding('Seeing', ['R'], texts.keys.resetWindow, plainly('r'), { name: 'reset-window' }),
  binding('Seeing', ['Shift + L'], texts.top.themeDoes, shifted('l'), { name: 'theme' }),
  ...Object.values(texts.keys.mouse).map(({ shown, does }) => mouse(shown, does)),
];

/** What a key does with a tool in hand. */
export function actionFor(key: KeyInput, tool: ToolName | null = null): Action | null {
  const meant = BINDINGS.filter(({ action, matches }) => action && matches(key));
  const special = meant.find(({ tools }) => tool !== null && tools?.includes(tool));
  return (special ?? meant.find(({ tools }) => !tools))?.action ?? null;
}

function tracingKey({ shown, does, key, held, tools, command }: TracingKey): Binding {
  const matches = (input: KeyInput) =>
    !input.alt && is(input, key) && (held === 'any' || (input.ctrl === (held === 'ctrl') && input.shift === (held === 'shift')));
  return { group: 'Shaping', shown, does, matches, action: { name: 'tracing', command }, tools };
}

function workKey({ shown, key, shift, alt = false, command }: WorkKey): Binding {
  const matches = (input: KeyInput) => !input.ctrl && input.shift === shift && input.alt === alt && is(input, key);
  return { group: 'Working', shown: [shown], does: texts.work.keys[command], matches, action: { name: 'work', command } };
}

function binding(
  group: Binding['group'],
  shown: readonly string[],
  does: string,
  matches: Binding['matches'],
  action: Action,
): Binding {
  return { group, shown, does, matches, action };
}

/** A key that something else runs. */
function told(shown: readonly string[], does: string): Binding {
  return { group: 'Working', shown, does, matches: () => false, action: null };
}

function mouse(shown: string, does: string): Binding {
  return { group: 'Mouse', shown: [shown], does, matches: () => false, action: null };
}

function is(key: KeyInput, ...names: readonly string[]): boolean {
  return names.includes(key.key.toLowerCase());
}

function plainly(...names: readonly string[]) {
  return (key: KeyInput) => !key.ctrl && !key.shift && !key.alt && is(key, ...names);
}

function shifted(...names: readonly string[]) {
  return (key: KeyInput) => !key.ctrl && key.shift && !key.alt && is(key, ...names);
}
