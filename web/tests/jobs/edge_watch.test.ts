import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { addFrames, loadPoses, setCalibration, setModel } from '../../src/document/commands';
import { Store } from '../../src/document/store';
import { cellOf, chosenCandidate } from '../../src/document/types';
import type { PoseNumbers } from '../../src/geometry/pose_numbers';
import { EDGES_REST, EdgeWatch } from '../../src/jobs/edge_watch';
import type { ComponentName } from '../../src/terms/component';

const poseOf = (x: number): PoseNumbers => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });
const FACTS = { numbers: new Float32Array(), met: 0.9, known: 1, residual: 0.4 };
const FRAMES = ['f', 'g'].map((id, at) => ({ id, name: id, source: 's', indexInSource: at, width: 100, height: 100 }));

/** Two frames whose pixels are at hand or not, with poses of both components. */
function bench({ pixels = true } = {}) {
  const store = new Store();
  const asked: { component: ComponentName; x: number }[] = [];
  const call = async (_method: string, { component, pose }: { component: ComponentName; pose: PoseNumbers }) => {
    asked.push({ component, x: pose.x });
    return FACTS;
  };
  let pixelsAsked = 0;
  const studio = { framePixels: () => (++pixelsAsked && pixels ? { pixels: new Uint8Array(4), width: 2, height: 2, covered: new Uint32Array() } : null) };
  const watch = new EdgeWatch({ store, studio } as unknown as ConstructorParameters<typeof EdgeWatch>[0], { call } as unknown as ConstructorParameters<typeof EdgeWatch>[1]);
  store.perform(addFrames(FRAMES));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  for (const component of ['femur', 'tibia'] as const) {
    store.perform(setModel(component, { name: component, sha256: component }));
    store.setLibrary(component, { state: 'ready', key: 'k', views: 1, bytes: 1, seconds: null });
  }
  store.perform(loadPoses('femur', [poseOf(1), poseOf(2)], 'femur.jts'));
  const shown = (component: ComponentName) => watch.of(chosenCandidate(cellOf(store.doc, store.doc.frames[store.ui.frameIndex]!.id, component)));
  return { store, asked, shown, pixelsAsked: () => pixelsAsked };
}

const rest = () => vi.advanceTimersByTimeAsync(10 * EDGES_REST);

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe('edges along the models on view', () => {
  it('are read once of the frame on which somebody rests, and not of those that pass', async () => {
    const { store, asked, shown } = bench();
    await vi.advanceTimersByTimeAsync(EDGES_REST - 10);
    expect(asked).toEqual([]);
    store.goTo(1);
    await rest();
    expect(asked).toEqual([{ component: 'femur', x: 2 }]);
    expect(shown('femur')).toBe(FACTS);
    expect(shown('tibia')).toBe(null);
    store.goTo(0);
    await rest();
    store.goTo(1);
    await rest();
    expect(asked.length).toBe(2);
  });

  it('are read again when another component comes to lie there, whose edges do not count', async () => {
    const { store, asked } = bench();
    await rest();
    store.perform(loadPoses('tibia', [poseOf(7), poseOf(8)], 'tibia.jts'));
    await rest();
    expect(asked).toEqual([
      { component: 'femur', x: 1 },
      { component: 'femur', x: 1 },
      { component: 'tibia', x: 7 },
    ]);
  });

  it('are not asked for again where the frame has no pixels', async () => {
    const { asked, shown, pixelsAsked } = bench({ pixels: false });
    await rest();
    expect(pixelsAsked()).toBe(1);
    expect(asked).toEqual([]);
    expect(shown('femur')).toBe(null);
  });
});
