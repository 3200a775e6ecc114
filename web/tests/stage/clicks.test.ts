import { expect, it } from 'vitest';
import { Store } from '../../src/document/store';
import { framePoint } from '../../src/geometry/points';
import { drawClicks } from '../../src/stage/stage_extras';

it('a click that is being answered has a ring where it was, closed as far as the answer is', () => {
  const store = new Store();
  const job = { id: 1, title: 'a click', unit: '%', startedAt: 0, cancel: () => undefined, total: 100 };
  const place = { frameId: 'f', component: 'tibia' } as const;
  store.setJob({ ...job, done: 40, place, at: framePoint(30, 20) });
  store.setJob({ ...job, id: 2, done: 70, place: { ...place, frameId: 'g' }, at: framePoint(5, 5) });
  store.setJob({ ...job, id: 3, done: 70, place });
  const arcs: number[][] = [];
  const context = { beginPath: () => undefined, stroke: () => undefined, arc: (...numbers: number[]) => arcs.push(numbers) };
  const frame = { id: 'f', name: 'f', source: 's', indexInSource: 0, width: 64, height: 64 };
  drawClicks(context as never, store.state, frame, { scale: 2, left: 10, top: 0 });
  const [x, y] = [10 + 2 * 30, 2 * 20];
  expect(arcs.map(([column, row, , from, to]) => [column, row, (to! - from!) / (2 * Math.PI)])).toEqual([
    [x, y, 1],
    [x, y, expect.closeTo(0.4)],
  ]);
});
