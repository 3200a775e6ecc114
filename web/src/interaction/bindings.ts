import { texts } from '../texts';
import { AID_KEYS, AID_ROWS, type AidCommand, type AidKey } from './aid_keys';
import { TOOLS, type ToolName } from './tools';
import { WORK_KEYS, type WorkCommand, type WorkKey } from './work_keys';

/** What keys do. The sheet that `?` shows is made from this table, so the two cannot differ. */
export type Action =
  | { readonly name: 'tool'; readonly tool: ToolName }
  | { readonly name: 'aid'; readonly command: AidCommand }
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
  ...AID_KEYS.map(aidKey),
  ...AID_ROWS.map(({ shown, does }): Binding => ({ group: 'Shaping', shown, does, matches: () => false, action: null })),
  ...TOOLS.map(({ name, key, title }) =>
    binding('Tracing', [key.toUpperCase()], title, plainly(key), { name: 'tool', tool: name }),
  ),
  binding('Tracing', ['Enter'], 'Close the outline', plainly('enter'), { name: 'close-outline' }),
  binding('Tracing', ['Delete', 'Backspace'], 'Delete the selected point, or the last one of a draft', plainly('delete', 'backspace'), {
    name: 'delete-point',
  }),
  binding('Tracing', ['Shift + Delete'], 'Delete the whole outline', shifted('delete', 'backspace'), { name: 'delete-outline' }),
  binding('Tracing', [','], 'Select the previous point', plainly(','), { name: 'previous-point' }),
  binding('Tracing', ['.'], 'Select the next point', plainly('.'), { name: 'next-point' }),
  binding('Tracing', ['U'], 'Mark the side under the pointer, or after the selected point, unknown or known', plainly('u'), {
    name: 'toggle-unknown',
  }),
  binding('Tracing', ['Esc'], 'Leave the tool; a draft stays', plainly('escape'), { name: 'leave' }),
  binding('Tracing', ['X'], 'Switch between the pose and its rivals', plainly('x'), { name: 'other-candidate' }),
  binding('Working', ['D', 'Page Up'], 'Previous frame', plainly('d', 'pageup'), { name: 'previous-frame' }),
  binding('Working', ['F', 'Page Down'], 'Next frame', plainly('f', 'pagedown'), { name: 'next-frame' }),
  binding('Working', ['C'], 'Other component', plainly('c'), { name: 'other-component' }),
  ...WORK_KEYS.map(workKey),
  binding('Working', ['Ctrl + Z'], 'Undo', (key) => key.ctrl && !key.shift && is(key, 'z'), { name: 'undo' }),
  binding(
    'Working',
    ['Ctrl + Y', 'Ctrl + Shift + Z'],
    'Redo',
    (key) => key.ctrl && (is(key, 'y') || (key.shift && is(key, 'z'))),
    { name: 'redo' },
  ),
  binding('Working', ['Ctrl + S'], 'Save the session', (key) => key.ctrl && is(key, 's'), { name: 'save' }),
  binding('Working', ['Ctrl + O'], 'Open files', (key) => key.ctrl && is(key, 'o'), { name: 'open' }),
  binding('Working', ['?'], 'This sheet', (key) => is(key, '?'), { name: 'keys' }),
  binding('Seeing', ['0'], 'Fit the film to the window', plainly('0'), { name: 'fit' }),
  binding('Seeing', ['+'], 'Zoom in', (key) => is(key, '+', '='), { name: 'zoom-in' }),
  binding('Seeing', ['-'], 'Zoom out', plainly('-'), { name: 'zoom-out' }),
  binding('Seeing', ['R'], 'Window and level as the film suggests', plainly('r'), { name: 'reset-window' }),
  binding('Seeing', ['Shift + L'], texts.top.themeDoes, shifted('l'), { name: 'theme' }),
  mouse('Space held', 'Hide outlines and overlays; dragging moves the film'),
  mouse('Wheel', 'Zoom at the cursor'),
  mouse('Middle drag', 'Move the film'),
  mouse('Right drag', 'Window (sideways) and level (up and down)'),
  mouse('Alt + click on a point', 'Delete the point'),
  mouse('Click on an edge', 'Insert a point (closed outline, or Edit points)'),
  mouse('Double click', 'Close the outline'),
];

/** What a key does with a tool in hand. */
export function actionFor(key: KeyInput, tool: ToolName | null = null): Action | null {
  const meant = BINDINGS.filter(({ action, matches }) => action && matches(key));
  const special = meant.find(({ tools }) => tool !== null && tools?.includes(tool));
  return (special ?? meant.find(({ tools }) => !tools))?.action ?? null;
}

function aidKey({ shown, does, key, held, tools, command }: AidKey): Binding {
  const matches = (input: KeyInput) =>
    !input.alt && is(input, key) && (held === 'any' || (input.ctrl === (held === 'ctrl') && input.shift === (held === 'shift')));
  return { group: 'Shaping', shown, does, matches, action: { name: 'aid', command }, tools };
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
