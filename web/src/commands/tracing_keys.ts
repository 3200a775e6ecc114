import type { ToolName } from '../terms/tool';
import { texts } from '../texts/texts';

/** What keys and buttons do with whole outlines and with the tools' options. */
export type TracingCommand =
  | { readonly what: 'move'; readonly columns: number; readonly rows: number }
  | { readonly what: 'turn'; readonly degrees: number }
  | { readonly what: 'scale'; readonly factor: number }
  /** The place on the frame that the keyboard points at, frame pixels. */
  | { readonly what: 'point'; readonly columns: number; readonly rows: number }
  | { readonly what: 'press' }
  /** Of the tool in hand: the brush's radius, the threshold's level. */
  | { readonly what: 'size'; readonly steps: number }
  | { readonly what: 'erase' }
  | { readonly what: 'accept' }
  | { readonly what: 'take-back' }
  | { readonly what: 'copy'; readonly step: -1 | 1 }
  | { readonly what: 'snap' }
  | { readonly what: 'shape' }
  | { readonly what: 'all-known' };

export interface TracingKey {
  /** As on the sheet; none where another row tells of it. */
  readonly shown: readonly string[];
  readonly does: string;
  readonly key: string;
  readonly held: 'none' | 'shift' | 'ctrl' | 'any';
  /** Only with these tools; with all of them where there are none. */
  readonly tools?: readonly ToolName[];
  readonly command: TracingCommand;
}

const FINE = 1;
const COARSE = 10;
const DEGREE = 1;
const PERCENT = 1.01;

/** Tools that work where the pointer is. */
export const POINTING: readonly ToolName[] = ['trace', 'wire', 'threshold', 'one-click', 'brush', 'stretch'];
const MOVING: readonly ToolName[] = ['edit', 'transform'];

const DIRECTIONS = [
  ['arrowleft', -1, 0],
  ['arrowright', 1, 0],
  ['arrowup', 0, -1],
  ['arrowdown', 0, 1],
] as const;

export const TRACING_KEYS: readonly TracingKey[] = [
  { shown: ['S'], does: texts.keys.tracing.snap, key: 's', held: 'none', command: { what: 'snap' } },
  { shown: ['Shift + S'], does: texts.keys.tracing.shape, key: 's', held: 'shift', command: { what: 'shape' } },
  { shown: ['Shift + D'], does: texts.keys.tracing.copyPrevious, key: 'd', held: 'shift', command: { what: 'copy', step: -1 } },
  { shown: ['Shift + F'], does: texts.keys.tracing.copyNext, key: 'f', held: 'shift', command: { what: 'copy', step: 1 } },
  { shown: ['['], does: texts.keys.tracing.smaller, key: '[', held: 'any', command: { what: 'size', steps: -1 } },
  { shown: [']'], does: texts.keys.tracing.larger, key: ']', held: 'any', command: { what: 'size', steps: 1 } },
  { shown: ['E'], does: texts.keys.tracing.erase, key: 'e', held: 'none', command: { what: 'erase' } },
  { shown: ['I'], does: texts.keys.tracing.press, key: 'i', held: 'none', tools: POINTING, command: { what: 'press' } },
  ...DIRECTIONS.flatMap(([key, x, y]) => [
    hidden(key, 'none', MOVING, { what: 'move', columns: FINE * x, rows: FINE * y }),
    hidden(key, 'shift', MOVING, { what: 'move', columns: COARSE * x, rows: COARSE * y }),
    hidden(key, 'none', POINTING, { what: 'point', columns: FINE * x, rows: FINE * y }),
    hidden(key, 'shift', POINTING, { what: 'point', columns: COARSE * x, rows: COARSE * y }),
  ]),
  hidden('arrowleft', 'ctrl', ['transform'], { what: 'turn', degrees: -DEGREE }),
  hidden('arrowright', 'ctrl', ['transform'], { what: 'turn', degrees: DEGREE }),
  hidden('arrowup', 'ctrl', ['transform'], { what: 'scale', factor: PERCENT }),
  hidden('arrowdown', 'ctrl', ['transform'], { what: 'scale', factor: 1 / PERCENT }),
  hidden('enter', 'none', ['threshold', 'wire'], { what: 'accept' }),
  hidden('enter', 'none', ['one-click'], { what: 'press' }),
  hidden('backspace', 'none', ['wire'], { what: 'take-back' }),
];

/** Rows of the sheet for keys whose meaning depends on the tool. */
export const TRACING_ROWS: readonly { readonly shown: readonly string[]; readonly does: string }[] = texts.keys.tracing.rows;

function hidden(key: string, held: TracingKey['held'], tools: readonly ToolName[], command: TracingCommand): TracingKey {
  return { shown: [], does: '', key, held, tools, command };
}
