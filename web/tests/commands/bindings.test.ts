import { describe, expect, it } from 'vitest';
import { actionFor, BINDINGS } from '../../src/commands/bindings';
import type { ToolName } from '../../src/terms/tool';

const press = (key: string, held: Partial<{ ctrl: boolean; shift: boolean; alt: boolean }> = {}) =>
  actionFor({ key, ctrl: false, shift: false, alt: false, ...held });

const pressWith = (tool: ToolName, key: string, held: Partial<{ ctrl: boolean; shift: boolean; alt: boolean }> = {}) =>
  actionFor({ key, ctrl: false, shift: false, alt: false, ...held }, tool);

describe('keys', () => {
  it.each([
    ['p', {}, { name: 'tool', tool: 'trace' }],
    ['d', {}, { name: 'previous-frame' }],
    ['PageDown', {}, { name: 'next-frame' }],
    ['ArrowRight', {}, { name: 'next-frame' }],
    ['ArrowLeft', {}, { name: 'previous-frame' }],
    ['z', { ctrl: true }, { name: 'undo' }],
    ['Z', { ctrl: true, shift: true }, { name: 'redo' }],
    ['y', { ctrl: true }, { name: 'redo' }],
    ['s', { ctrl: true }, { name: 'save' }],
    ['?', { shift: true }, { name: 'keys' }],
    ['Delete', { shift: true }, { name: 'delete-outline' }],
    ['Backspace', {}, { name: 'delete-point' }],
  ])('%s with %o', (key, held, action) => {
    expect(press(key, held)).toEqual(action);
  });

  it('depends on the tool for some keys', () => {
    expect(pressWith('transform', 'ArrowLeft')).toEqual({ name: 'tracing', command: { what: 'move', columns: -1, rows: 0 } });
    expect(pressWith('wire', 'ArrowUp', { shift: true })).toEqual({ name: 'tracing', command: { what: 'point', columns: 0, rows: -10 } });
    expect(pressWith('transform', 'ArrowRight', { ctrl: true })).toEqual({ name: 'tracing', command: { what: 'turn', degrees: 1 } });
    expect(pressWith('hand', 'ArrowLeft')).toEqual({ name: 'previous-frame' });
    expect(pressWith('hand', 'ArrowUp')).toBeNull();
    expect(pressWith('wire', 'Backspace')).toEqual({ name: 'tracing', command: { what: 'take-back' } });
    expect(pressWith('trace', 'Backspace')).toEqual({ name: 'delete-point' });
    expect(pressWith('threshold', 's', { shift: true })).toEqual({ name: 'tracing', command: { what: 'shape' } });
  });

  it('leaves the browser its own', () => {
    expect(press('f', { ctrl: true })).toBeNull();
    expect(press('Tab', { shift: true })).toBeNull();
    expect(press('w', { ctrl: true })).toBeNull();
  });

  it('means one thing by each key', () => {
    for (const { shown, action, tools } of BINDINGS) {
      if (!action) continue;
      for (const keys of shown) {
        const [last = '', ...before] = keys === '+' ? ['+'] : keys.split(' + ').reverse();
        const key = { 'Page Up': 'PageUp', 'Page Down': 'PageDown', Esc: 'Escape', '←': 'ArrowLeft', '→': 'ArrowRight' }[last] ?? last;
        const held = { ctrl: before.includes('Ctrl'), shift: before.includes('Shift'), alt: before.includes('Alt') };
        expect(pressWith(tools?.[0] ?? 'hand', key, held), keys).toEqual(action);
      }
    }
  });
});
