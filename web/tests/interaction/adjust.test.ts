import { describe, expect, it } from 'vitest';
import { DEFAULT_SEEING } from '../../src/terms/seeing';
import { Store } from '../../src/document/store';
import { cellOf } from '../../src/document/types';
import { type Locks, NO_LOCKS, type PoseNumbers } from '../../src/geometry/pose_numbers';
import { canvasPoint, type CanvasPoint } from '../../src/geometry/points';
import { inCamera, projected } from '../../src/geometry/pose_motion';
import { adjust, type AdjustState, centreOf, handleAt, knobs, RING } from '../../src/interaction/adjust';
import type { HandSituation } from '../../src/interaction/hand_situation';
import { BINDINGS } from '../../src/commands/bindings';
import { HAND_BINDINGS, handActionFor } from '../../src/commands/hand_bindings';
import type { Input, Situation } from '../../src/interaction/machine';
import { SEEING_BINDINGS, seeingActionFor, seeingKey } from '../../src/commands/seeing_bindings';
import { barLength } from '../../src/stage/scale_length';

const POSE: PoseNumbers = { x: 5, y: -12, z: -1000, zRot: 35, xRot: 8, yRot: -14 };
const CAMERA = { fx: 3200, fy: 3200, cx: 512, cy: 500 };
const VIEW = { scale: 0.75, left: 20, top: 10 };
const PLACE = { frameId: 'f', component: 'femur' } as const;

/** A model in hand: inputs go in, the document holds what comes out. */
function bench(change: { locks?: Partial<Locks>; fine?: boolean; absent?: boolean } = {}) {
  const store = new Store();
  let state: AdjustState = adjust.start;
  const posed = () => {
    const { result } = cellOf(store.doc, 'f', 'femur');
    return result?.kind === 'posed' ? (result.candidates[0]?.pose ?? null) : null;
  };
  const hand = (): HandSituation => ({
    pose: posed() ?? POSE,
    absent: (change.absent ?? false) && posed() === null,
    middle: [10, 5, -3],
    camera: CAMERA,
    locks: { ...NO_LOCKS, ...change.locks },
    fine: change.fine ?? false,
  });
  const send = (type: Input['type'], at: CanvasPoint, held: Partial<Input> = {}) => {
    const situation = { viewport: VIEW, frame: { width: 1024, height: 1024 }, place: PLACE, outline: null, window: { centre: 0, width: 1 }, erase: false, hand: hand() } as Situation;
    const { state: next, effects } = adjust.next(state, { type, at, button: 'primary', alt: false, ...held }, situation);
    state = next;
    for (const effect of effects) {
      if (effect.type === 'preview') store.preview(effect.command);
      if (effect.type === 'commit') store.commit(effect.command);
      if (effect.type === 'cancel-preview') store.cancelPreview();
    }
  };
  const drag = (from: CanvasPoint, to: CanvasPoint, held: Partial<Input> = {}) => {
    send('down', from, held);
    for (let step = 1; step <= 8; step++) {
      const fraction = step / 8;
      send('move', canvasPoint(from.x + fraction * (to.x - from.x), from.y + fraction * (to.y - from.y)), held);
    }
    send('up', to, held);
  };
  return { store, hand, posed, send, drag };
}

const at = (pose: PoseNumbers) => projected(CAMERA, inCamera(pose, [10, 5, -3]));

describe('a model in hand', () => {
  it('goes where the mouse goes, as one step back', () => {
    const { store, drag, posed } = bench();
    drag(canvasPoint(300, 300), canvasPoint(342, 276));
    const [before, after] = [at(POSE), at(posed() as PoseNumbers)];
    expect((after?.column ?? 0) - (before?.column ?? 0)).toBeCloseTo(42 / VIEW.scale, 6);
    expect((after?.row ?? 0) - (before?.row ?? 0)).toBeCloseTo(-24 / VIEW.scale, 6);
    expect(posed()?.zRot).toBe(POSE.zRot);
    store.undo();
    expect(posed()).toBeNull();
  });

  it('moves a fifth as far in fine steps', () => {
    const { drag, posed } = bench({ fine: true });
    drag(canvasPoint(300, 300), canvasPoint(400, 300));
    expect((at(posed() as PoseNumbers)?.column ?? 0) - (at(POSE)?.column ?? 0)).toBeCloseTo(20 / VIEW.scale, 6);
  });

  it('turns with the ring, and with Ctrl held, as far as the hand goes round', () => {
    for (const held of [{}, { ctrl: true }]) {
      const { hand, drag, posed } = bench();
      const centre = centreOf(hand(), VIEW) as CanvasPoint;
      const angle = Math.PI / 6;
      const end = canvasPoint(centre.x + RING * Math.cos(angle), centre.y - RING * Math.sin(angle));
      drag(canvasPoint(centre.x + RING, centre.y), end, held);
      expect(posed()?.zRot).toBeCloseTo(POSE.zRot + 30, 0);
      expect(Math.abs((posed()?.xRot ?? 0) - POSE.xRot)).toBeLessThan(0.5);
    }
  });

  it('tilts by the knob in the middle and with Shift, and goes nearer by the knob below', () => {
    const { hand, drag, posed } = bench();
    const centre = centreOf(hand(), VIEW) as CanvasPoint;
    drag(centre, canvasPoint(centre.x + 40, centre.y));
    const tilted = posed() as PoseNumbers;
    expect(tilted.yRot).not.toBeCloseTo(POSE.yRot, 1);
    const below = knobs(centreOf(hand(), VIEW) as CanvasPoint).depth;
    drag(below, canvasPoint(below.x, below.y + 50));
    expect(posed()?.z).toBeGreaterThan(tilted.z + 40);
    const shifted = bench();
    shifted.drag(canvasPoint(100, 100), canvasPoint(140, 100), { shift: true });
    expect(shifted.posed()?.yRot).toBeCloseTo(tilted.yRot, 6);
  });

  it('keeps what is locked', () => {
    const { drag, posed } = bench({ locks: { y: true, zRot: true } });
    drag(canvasPoint(300, 300), canvasPoint(360, 360));
    drag(canvasPoint(300, 300), canvasPoint(360, 390), { ctrl: true });
    expect([posed()?.y, posed()?.zRot]).toEqual([POSE.y, POSE.zRot]);
    expect(posed()?.x).not.toBe(POSE.x);
  });

  it('is placed by the first press where there is none, and a trembling click changes nothing', () => {
    const absent = bench({ absent: true });
    absent.drag(canvasPoint(300, 300), canvasPoint(300, 300));
    expect(absent.posed()).toEqual(POSE);
    const there = bench();
    there.drag(canvasPoint(300, 300), canvasPoint(301, 301));
    expect(there.posed()).toBeNull();
  });

  it('lets go with Esc', () => {
    const { send, posed, store } = bench();
    send('down', canvasPoint(300, 300));
    send('move', canvasPoint(350, 300));
    expect(posed()).not.toBeNull();
    send('cancel', canvasPoint(0, 0));
    expect(posed()).toBeNull();
    expect(store.state.history.past).toHaveLength(0);
  });

  it('has handles that do not lie over each other', () => {
    const { hand } = bench();
    const centre = centreOf(hand(), VIEW) as CanvasPoint;
    const places = knobs(centre);
    expect(handleAt(hand(), VIEW, places.turn)).toBe('turn');
    expect(handleAt(hand(), VIEW, places.depth)).toBe('depth');
    expect(handleAt(hand(), VIEW, places.tilt)).toBe('tilt');
    expect(handleAt(hand(), VIEW, canvasPoint(centre.x + 35, centre.y + 20))).toBeNull();
    expect(handleAt(hand(), VIEW, canvasPoint(centre.x - RING, centre.y))).toBe('turn');
  });
});

describe('keys', () => {
  const press = (key: string, held: Partial<Record<'ctrl' | 'shift' | 'alt', boolean>> = {}) => ({ key, ctrl: false, shift: false, alt: false, ...held });

  it('are those of the field: arrows alone, with Ctrl and with Shift', () => {
    const nudge = (field: string, sign: number) => ({ name: 'nudge', field, sign });
    expect(handActionFor(press('ArrowLeft'))).toEqual(nudge('x', -1));
    expect(handActionFor(press('ArrowUp'))).toEqual(nudge('y', 1));
    expect(handActionFor(press('ArrowUp', { ctrl: true }))).toEqual(nudge('z', 1));
    expect(handActionFor(press('ArrowLeft', { ctrl: true }))).toEqual(nudge('zRot', 1));
    expect(handActionFor(press('ArrowDown', { shift: true }))).toEqual(nudge('xRot', 1));
    expect(handActionFor(press('ArrowRight', { shift: true }))).toEqual(nudge('yRot', 1));
    expect(handActionFor(press('+', { shift: true }))).toEqual({ name: 'coarse' });
    expect(handActionFor(press('-'))).toEqual({ name: 'fine' });
    expect(handActionFor(press('ArrowLeft', { ctrl: true, shift: true }))).toBeNull();
    expect(handActionFor(press('d'))).toBeNull();
  });

  it('of seeing mean nothing else in the page', () => {
    for (const { shown } of SEEING_BINDINGS) {
      const input = press((shown[0] ?? '').toLowerCase());
      const others = BINDINGS.filter(({ action, matches }) => action && matches(input)).map(({ does }) => does);
      expect(others, `${shown[0]}`).toEqual([]);
      expect(seeingActionFor(input), `${shown[0]}`).not.toBeNull();
    }
    expect(seeingKey({ name: 'preprocessing', preprocessing: 'edges' })).toBe('3');
  });

  it('leave no key of the hand without a row on the sheet', () => {
    expect(HAND_BINDINGS.every(({ shown, does }) => shown.length > 0 && does.length > 0)).toBe(true);
    expect(Object.keys(DEFAULT_SEEING).length).toBeGreaterThan(0);
  });
});

describe('the scale bar', () => {
  it('is a round length between 60 and 160 px', () => {
    for (let perMillimetre = 0.01; perMillimetre < 1000; perMillimetre *= 1.37) {
      const length = barLength(perMillimetre) as number;
      const pixels = length * perMillimetre;
      expect(pixels).toBeGreaterThanOrEqual(60);
      expect(pixels).toBeLessThanOrEqual(160 + 1e-9);
      expect([1, 2, 5]).toContain(Math.round(length / 10 ** Math.floor(Math.log10(length) + 1e-9)));
    }
    expect(barLength(Number.NaN)).toBeNull();
  });
});
