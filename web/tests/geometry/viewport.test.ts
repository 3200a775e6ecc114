import { describe, expect, it } from 'vitest';
import { canvasPoint, framePoint, nearestOnSegment } from '../../src/geometry/points';
import { canvasFromFrame, fit, frameFromCanvas, pan, recentre, zoomAt } from '../../src/geometry/viewport';

const view = { scale: 0.75, left: 13, top: -40 };

describe('viewport', () => {
  it('goes to the canvas and back', () => {
    const p = framePoint(123.25, 987.5);
    const back = frameFromCanvas(view, canvasFromFrame(view, p));
    expect(back.column).toBeCloseTo(p.column, 10);
    expect(back.row).toBeCloseTo(p.row, 10);
  });

  it('keeps what lies under the cursor when zooming', () => {
    const cursor = canvasPoint(200, 300);
    const before = frameFromCanvas(view, cursor);
    const after = frameFromCanvas(zoomAt(view, cursor, 3.7), cursor);
    expect(after.column).toBeCloseTo(before.column, 9);
    expect(after.row).toBeCloseTo(before.row, 9);
  });

  it('stops at a smallest and a largest scale', () => {
    const cursor = canvasPoint(0, 0);
    expect(zoomAt(view, cursor, 1e9).scale).toBe(64);
    expect(zoomAt(view, cursor, 1e-9).scale).toBe(0.05);
  });

  it('fits the whole frame, centred', () => {
    const fitted = fit({ width: 1024, height: 512 }, { width: 600, height: 800 });
    const upper = canvasFromFrame(fitted, framePoint(0, 0));
    const lower = canvasFromFrame(fitted, framePoint(1024, 512));
    expect(upper.x).toBeGreaterThanOrEqual(0);
    expect(lower.x).toBeLessThanOrEqual(600);
    expect(upper.x + lower.x).toBeCloseTo(600, 9);
    expect(upper.y + lower.y).toBeCloseTo(800, 9);
  });

  it('keeps the middle in the middle when the canvas changes', () => {
    const before = frameFromCanvas(view, canvasPoint(50, 50));
    const wider = recentre(view, { width: 100, height: 100 }, { width: 300, height: 200 });
    const after = frameFromCanvas(wider, canvasPoint(150, 100));
    expect(after.column).toBeCloseTo(before.column, 9);
    expect(after.row).toBeCloseTo(before.row, 9);
  });

  it('pans by canvas pixels', () => {
    expect(pan(view, 5, -7)).toEqual({ scale: 0.75, left: 18, top: -47 });
  });
});

describe('nearestOnSegment', () => {
  const a = canvasPoint(0, 0);
  const b = canvasPoint(10, 0);
  it.each([
    [canvasPoint(4, 3), 4],
    [canvasPoint(-5, 1), 0],
    [canvasPoint(15, 1), 10],
  ])('stays on the segment', (p, x) => {
    expect(nearestOnSegment(p, a, b)).toMatchObject({ x, y: 0 });
  });

  it('is the point itself for a segment without length', () => {
    expect(nearestOnSegment(b, a, a)).toBe(a);
  });
});
