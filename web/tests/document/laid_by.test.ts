import { describe, expect, it } from 'vitest';
import { addPoint, closeOutline, deletePoint, insertPoint, movePoint } from '../../src/document/commands';
import * as history from '../../src/document/history';
import { byTool, isDiscarded } from '../../src/document/laid_by';
import { addPoints, copyOutline, markAllKnown, nudgeOutline, setOutline } from '../../src/document/outlines';
import type { Command } from '../../src/document/command';
import { cellOf, EMPTY_DOC, type Outline } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import { moved } from '../../src/geometry/similarity';

const PLACE = { frameId: 'f', component: 'femur' } as const;
const POINTS = [framePoint(1, 1), framePoint(9, 1), framePoint(5, 9)];
const TOOL: Outline = { points: POINTS, closed: true, unknownSides: [1], laidBy: 'tool' };

/** Who laid the outline after these commands. */
function laid(...commands: Command[]): Outline['laidBy'] {
  const done = commands.reduce(history.perform, history.startHistory(EMPTY_DOC));
  return cellOf(done.present, 'f', 'femur').outline?.laidBy;
}

const taken = setOutline(PLACE, 'take a region', TOOL);
const point = framePoint(7, 7);

describe('who laid an outline', () => {
  it('a hand leaves no word', () => {
    expect(laid(addPoint(PLACE, POINTS[0]!), addPoint(PLACE, POINTS[1]!), addPoint(PLACE, POINTS[2]!), closeOutline(PLACE), movePoint(PLACE, 0, point))).toBeUndefined();
  });

  it.each([
    ['moves a point', movePoint(PLACE, 0, point)],
    ['inserts one', insertPoint(PLACE, 1, point)],
    ['deletes one', deletePoint(PLACE, 1)],
    ['moves all of it', nudgeOutline(PLACE, moved(1, 0))],
    ['copies it to another frame', copyOutline(PLACE, TOOL, 'frame 1')],
  ] as const)('a hand that %s mixes', (_, command) => {
    expect(laid(taken, command)).toBe('mixed');
    const click = setOutline(PLACE, 'click', { ...TOOL, laidBy: 'click' });
    const copied = copyOutline(PLACE, { ...TOOL, laidBy: 'click' }, 'frame 1');
    expect(laid(click, command.label.startsWith('copy') ? copied : command)).toBe('mixed');
  });

  it('what lays nothing changes nothing', () => {
    expect(laid(taken, markAllKnown(PLACE))).toBe('tool');
  });

  it('a tool that goes on with a draft mixes, unless it began it', () => {
    const draft = (count: number) => POINTS.slice(0, count).map((at) => addPoint(PLACE, at));
    const stretch = addPoints(PLACE, 'follow the edge', [point], false, byTool);
    expect(laid(stretch, stretch)).toBe('tool');
    expect(laid(...draft(1), stretch)).toBe('tool');
    expect(laid(...draft(2), stretch)).toBe('mixed');
    expect(laid(stretch, stretch, addPoint(PLACE, point))).toBe('mixed');
  });
});

describe('where a click led', () => {
  const click: Outline = { ...TOOL, laidBy: 'click' };
  const failed = { kind: 'failed', origin: 'k', sentence: 'Nothing fits.' } as const;

  it('is no finding where no pose came of it, until somebody draws on', () => {
    expect(isDiscarded({ outline: click, result: failed, resultOf: click })).toBe(true);
    expect(isDiscarded({ outline: { ...click, laidBy: 'mixed' }, result: failed, resultOf: click })).toBe(false);
    expect(isDiscarded({ outline: TOOL, result: failed, resultOf: TOOL })).toBe(false);
    expect(isDiscarded({ outline: click, result: null, resultOf: null })).toBe(false);
    expect(isDiscarded({ outline: null, result: failed, resultOf: null })).toBe(false);
  });
});
