import { describe, expect, it } from 'vitest';
import { withMark, withMovedMark, withTyped } from '../../src/document/measuring';
import { isMeant } from '../../src/exchange/reading';
import { canvasPoint, framePoint } from '../../src/geometry/points';
import type { Effect, Input, Situation } from '../../src/interaction/machine';
import { ruler, type RulerState } from '../../src/interaction/ruler';

describe('marks of a ruler', () => {
  const [a, b] = [framePoint(10, 10), framePoint(100, 10)];

  it('are set one after the other; a third click moves the nearer one', () => {
    expect(withMark([], a)).toEqual([a]);
    expect(withMark([a], b)).toEqual([a, b]);
    expect(withMark([a, b], framePoint(90, 12))).toEqual([a, framePoint(90, 12)]);
    expect(withMark([a, b], framePoint(20, 12))).toEqual([framePoint(20, 12), b]);
  });

  it('go with the pointer while the button is held', () => {
    expect(withMovedMark([a], framePoint(12, 11))).toEqual([framePoint(12, 11)]);
    expect(withMovedMark([a, b], framePoint(99, 11))).toEqual([a, framePoint(99, 11)]);
  });
});

describe('numbers of marks that are typed', () => {
  it('leave the others as they are', () => {
    const once = withTyped([], 0, { column: 12.5 });
    expect(once).toEqual([framePoint(12.5, NaN)]);
    const twice = withTyped(once, 0, { row: 7 });
    expect(withTyped(twice, 1, { row: 3 })).toEqual([framePoint(12.5, 7), framePoint(NaN, 3)]);
    expect(withTyped(twice, 0, { column: NaN })).toEqual([framePoint(NaN, 7)]);
    expect(withTyped([framePoint(1, NaN)], 0, { column: NaN })).toEqual([]);
  });
});

describe('the pointer on a ruler', () => {
  const situation = { viewport: { scale: 2, left: 0, top: 0 }, frame: { width: 100, height: 50 } } as Situation;
  const input = (type: Input['type'], x: number, y: number, button: Input['button'] = 'primary'): Input => ({ type, at: canvasPoint(x, y), button, alt: false });

  function run(inputs: readonly Input[]): { effects: Effect[]; state: RulerState } {
    let state = ruler.start;
    const effects: Effect[] = [];
    for (const each of inputs) {
      const next = ruler.next(state, each, situation);
      state = next.state;
      effects.push(...next.effects);
    }
    return { effects, state };
  }

  it('marks in frame coordinates, within the frame', () => {
    const { effects, state } = run([input('down', 20, 30), input('move', 24, 30), input('up', 500, 30)]);
    expect(effects).toEqual([
      { type: 'mark', at: framePoint(10, 15), begins: true },
      { type: 'mark', at: framePoint(12, 15), begins: false },
      { type: 'mark', at: framePoint(100, 15), begins: false },
    ]);
    expect(state.name).toBe('idle');
  });

  it('does nothing without a press, nor with another button', () => {
    expect(run([input('move', 20, 30), input('up', 20, 30), input('down', 20, 30, 'secondary')]).effects).toEqual([]);
  });
});

describe('files of a folder', () => {
  it('are meant unless a system left them there', () => {
    for (const path of ['/study/frames/1.png', 'knee.stl', '/a/calibration.txt']) expect(isMeant(path)).toBe(true);
    for (const path of ['/study/.DS_Store', '/study/Thumbs.db', '/x/__MACOSX/1.png', 'desktop.ini', '/cd/DICOMDIR']) expect(isMeant(path)).toBe(false);
  });
});
