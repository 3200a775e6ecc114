import { afterEach, describe, expect, it, vi } from 'vitest';
import { HandActions } from '../../src/commands/hand_actions';
import * as commands from '../../src/document/commands';
import { setPoseByHand } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { cellOf, chosenCandidate } from '../../src/document/types';

const PLACE = { frameId: 'f0', component: 'femur' } as const;

/** A frame with the model in it, and the clock that presses go by. */
function bench() {
  const store = new Store();
  const frame = { source: 's', width: 8, height: 8 };
  store.perform(commands.addFrames([0, 1].map((at) => ({ ...frame, id: `f${at}`, name: `f${at}`, indexInSource: at }))));
  store.perform(commands.setCalibration({ name: 'camera', text: 'a camera' }));
  store.perform(commands.setModel('femur', { name: 'femur.stl', sha256: 'a model' }));
  for (const frameId of ['f0', 'f1']) store.perform(setPoseByHand({ ...PLACE, frameId }, { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 }));
  const mesh = { vertices: new Float32Array([-1, -1, -1, 1, 1, 1]), triangles: new Uint32Array() };
  const studio = { meshOf: () => mesh, calibrationFacts: () => ({ camera: { fx: 4, fy: 4, cx: 4, cy: 4 }, principal: null }) };
  const hand = new HandActions({ store, studio } as never, {} as never, {} as never);
  const clock = vi.spyOn(performance, 'now').mockReturnValue(0);
  const press = (field: 'x' | 'y', at: number) => {
    clock.mockReturnValue(at);
    hand.run({ name: 'nudge', field, sign: 1 }, false);
  };
  const x = (frameId = 'f0') => chosenCandidate(cellOf(store.doc, frameId, 'femur'))!.pose.x;
  return { store, press, x };
}

afterEach(() => vi.restoreAllMocks());

describe('arrows pressed one after the other', () => {
  it('are one step back where no second lies between them', () => {
    const { store, press, x } = bench();
    for (const at of [0, 900, 1800]) press('x', at);
    const moved = x();
    press('x', 4000);
    store.undo();
    expect(x()).toBe(moved);
    store.undo();
    expect([moved > 0, x()]).toEqual([true, 0]);
  });

  it('of two directions, and in two frames, are steps of their own', () => {
    const { store, press, x } = bench();
    press('x', 0);
    press('y', 10);
    store.undo();
    expect(x()).toBeGreaterThan(0);
    press('x', 20);
    store.show({ frameIndex: 1 });
    press('x', 30);
    store.undo();
    expect([x('f1'), x() > 0]).toEqual([0, true]);
  });
});
