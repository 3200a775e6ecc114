import { describe, expect, it } from 'vitest';
import type { Place } from '../../src/document/command';
import { addFrames, setCalibration, setModel, withCell } from '../../src/document/commands';
import { bare, setPoseByHand } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { cellOf, type Posed } from '../../src/document/types';
import type { PoseNumbers } from '../../src/geometry/pose_numbers';
import { FirstPoses } from '../../src/jobs/first_poses';
import type { ComponentName } from '../../src/terms/component';
import type { Discovery, FindInput, PlanInput, PlanState, PlanStep, StepAnswer } from '../../src/workers/protocol/first_poses';

const poseOf = (x: number): PoseNumbers => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });
const discovery = (x: number): Discovery => ({ place: [x, 3], pose: poseOf(x), score: 0.5 });
const at = (frame: number, x: number) => ({ frame, pose: poseOf(x) });

/** An order of work that is written down: each step with what is known after it. */
type Script = readonly (readonly [PlanStep | null, PlanState['known']])[];

function bench(script: Script, way: number, answers: readonly (Discovery | null)[], distances: readonly (number | null)[] = [null]) {
  const store = new Store();
  store.perform(addFrames([0, 1, 2].map((k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }))));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  for (const component of ['femur', 'tibia'] as const) {
    store.perform(setModel(component, { name: component, sha256: component }));
    store.setLibrary(component, { state: 'ready' } as never);
  }
  const studio = { framePixels: () => ({ pixels: new Uint8Array(64), width: 8, height: 8, covered: new Uint32Array() }), meshOf: () => ({ vertices: new Float32Array(), triangles: new Uint32Array() }) };
  const asked: unknown[] = [];
  const planned: StepAnswer[] = [];
  let begun: PlanInput | null = null;
  const state = (): PlanState => ({ step: script[planned.length]![0], known: script[planned.length]![1], way: script[planned.length]![0] ? null : way });
  const left = [...answers];
  const worker = (component: ComponentName) => ({
    call: async (method: string, input: never) => {
      if (method === 'plan') return (begun = input), state();
      if (method === 'planned') return planned.push(input), state();
      const { bright, beside, library } = input as FindInput;
      asked.push(method === 'find' ? [component, bright, beside?.inJoint ?? null, ...(library === 0 ? [] : [library])] : `${component}: ${method}`);
      if (method === 'find') return left.shift() ?? null;
      if (method === 'isBright') return true;
      return method === 'beginWalk' ? 1 : { next: null, ends: Float64Array.of(1) };
    },
  });
  const clicked: [Place, boolean | null, number | undefined][] = [];
  const clicks = {
    ask: async (_: unknown, place: Place, bright: boolean | null, pose: PoseNumbers | null) => {
      clicked.push([place, bright, pose?.x]);
      const result: Posed = { kind: 'posed', from: 'outline', origin: 'o', candidates: [bare(pose!)], chosen: 0, reason: null, decided: true, verdict: null } as never;
      const outline = { points: [], closed: true, unknownSides: [] };
      store.perform({ label: 'click', apply: (doc) => withCell(doc, place, { ...cellOf(doc, place.frameId, place.component), outline, result, resultOf: outline }) });
    },
  };
  const opened: unknown[] = [];
  const libraries = {
    distances: async (_: ComponentName, __: unknown, depth: number | null) => (depth === null ? distances : distances.slice(0, 1)),
    bytes: async (component: ComponentName, distance: number | null) => (opened.push([component, distance]), new Uint8Array(1)),
  };
  const workers = { femur: worker('femur'), tibia: worker('tibia') } as never;
  const first = new FirstPoses({ store, studio } as never, clicks, libraries);
  const calledOff = { signal: new AbortController().signal, cancel: () => undefined };
  const find = async (wanted: readonly ComponentName[]) => (await first.find(wanted, workers, calledOff)).map(({ component }) => component);
  return { store, find, asked, planned, clicked, opened, begun: () => begun };
}

const step = (way: number, part: number, frame: number, search: PlanStep['search'], known: PoseNumbers | null = null): PlanStep => ({ way, part, frame, search, places: 'all', depth: search === 'beside' ? 1000 : null, known });
const NOTHING = [[null, null], [null, null]];

describe('first poses', () => {
  it('does what the order of work says, and sets what is found as soon as it is', async () => {
    const femur = [[at(1, 7), null], [null, null]];
    const { find, asked, planned, clicked } = bench(
      [[step(0, 0, 1, 'whole'), NOTHING], [step(0, 1, 1, 'joint', poseOf(7)), femur], [step(0, 0, 1, 'follow', poseOf(7)), femur], [null, [[at(1, 7), at(1, 8)], [null, null]]]],
      0,
      [discovery(7), discovery(8)],
    );
    expect(await find(['femur', 'tibia'])).toEqual(['femur', 'tibia']);
    expect(asked).toEqual(['femur: openSearch', ['femur', false, null], 'tibia: openSearch', ['tibia', false, true], 'femur: beginWalk', 'femur: walk']);
    expect(planned).toEqual([{ found: discovery(7) }, { found: discovery(8) }, { ends: Float64Array.of(1) }]);
    expect(clicked).toEqual([[{ frameId: 'f1', component: 'femur' }, false, 7], [{ frameId: 'f1', component: 'tibia' }, false, 8]]);
  });

  it('takes back what was found in a way that does not count in the end', async () => {
    const { store, find, clicked } = bench(
      [[step(0, 0, 1, 'whole'), NOTHING], [step(1, 0, 2, 'whole'), [[at(1, 7), null], [null, null]]], [null, [[at(1, 7), null], [at(2, 9), null]]]],
      1,
      [discovery(7), discovery(9)],
    );
    expect(await find(['femur', 'tibia'])).toEqual(['femur']);
    expect(clicked.map(([{ frameId }, bright]) => [frameId, bright])).toEqual([['f1', false], ['f2', true]]);
    expect([1, 2].map((frame) => cellOf(store.doc, `f${frame}`, 'femur').outline === null)).toEqual([true, false]);
  });

  it('compares a frame with the views from the next distance where it is found in none from the first, and opens each once', async () => {
    const { find, asked, opened, planned } = bench(
      [[step(0, 0, 1, 'whole'), NOTHING], [step(0, 0, 2, 'whole'), NOTHING], [step(0, 1, 2, 'beside', poseOf(7)), [[at(2, 7), null], [null, null]]], [null, [[at(2, 7), null], [null, null]]]],
      0,
      [null, null, null, discovery(7), null],
      [1300, 750],
    );
    expect(await find(['femur', 'tibia'])).toEqual(['femur']);
    expect(opened).toEqual([['femur', 1300], ['femur', 750], ['tibia', 1300]]);
    const femur = ['femur', false, null];
    expect(asked).toEqual(['femur: openSearch', femur, 'femur: addLibrary', [...femur, 1], femur, [...femur, 1], 'tibia: openSearch', ['tibia', false, false]]);
    expect(planned).toEqual([{ found: null }, { found: discovery(7) }, { found: null }]);
  });

  it('asks a component that is known how metal is shown, and leads on from there', async () => {
    const { store, find, asked, begun } = bench([[step(0, 1, 2, 'beside', poseOf(4)), NOTHING], [null, NOTHING]], 0, [null]);
    store.perform(setPoseByHand({ frameId: 'f2', component: 'femur' }, poseOf(4)));
    expect(await find(['tibia'])).toEqual([]);
    expect(begun()).toMatchObject({ frames: 3, told: true, parts: [{ component: 'femur', known: [at(2, 4)] }, { component: 'tibia', known: [] }] });
    expect(asked).toEqual(['femur: openSearch', 'femur: isBright', 'tibia: openSearch', ['tibia', true, false]]);
  });
});
