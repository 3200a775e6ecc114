import { describe, expect, it } from 'vitest';
import { actionFor, BINDINGS } from '../src/interaction/bindings';

const press = (key: string, held: Partial<{ ctrl: boolean; shift: boolean; alt: boolean }> = {}) =>
  actionFor({ key, ctrl: false, shift: false, alt: false, ...held });

describe('keys', () => {
  it.each([
    ['p', {}, { name: 'tool', tool: 'trace' }],
    ['d', {}, { name: 'previous-frame' }],
    ['PageDown', {}, { name: 'next-frame' }],
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

  it('leaves the browser its own', () => {
    expect(press('f', { ctrl: true })).toBeNull();
    expect(press('Tab', { shift: true })).toBeNull();
    expect(press('w', { ctrl: true })).toBeNull();
  });

  it('means one thing by each key', () => {
    for (const { shown, action } of BINDINGS) {
      if (!action || shown.some((keys) => keys.includes('+') && keys.length > 1)) continue;
      for (const keys of shown) {
        const key = keys === 'Page Up' ? 'PageUp' : keys === 'Page Down' ? 'PageDown' : keys === 'Esc' ? 'Escape' : keys;
        expect(press(key), keys).toEqual(action);
      }
    }
  });
});
