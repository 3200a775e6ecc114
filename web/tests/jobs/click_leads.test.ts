import { describe, expect, it } from 'vitest';
import type { Place } from '../../src/document/command';
import { addFrames, setCalibration, setModel, withCell } from '../../src/document/commands';
import { bare, setPoseByHand } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import { type Cell, cellOf, chosenCandidate, type Posed } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import type { PoseNumbers } from '../../src/geometry/pose_numbers';
import { ClickLeads } from '../../src/jobs/click_leads';
import type { Beforehand, FirstPoses } from '../../src/jobs/first_poses';
import type { ComponentName } from '../../src/terms/component';
import type { ClickOutcome } from '../../src/workers/protocol/first_poses';

const FRAMES = 6;
const poseOf = (x: number): PoseNumbers => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });

/** What the film tells: how each click's pose scores, where a component is found without it, and what comes of comparing both. */
interface Told {
  readonly scores?: Readonly<Record<number, number>>;
  readonly found?: Partial<Readonly<Record<ComponentName, number>>>;
  readonly outcome?: ClickOutcome;
  /** What a click once more beside the other component leads to; null where it leads nowhere else. */
  readonly again?: number | null;
}

function bench({ scores = {}, found = {}, outcome = 'leads', again = null }: Told, components: readonly ComponentName[] = ['femur']) {
  const store = new Store();
  store.perform(addFrames(Array.from({ length: FRAMES }, (_, k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }))));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  for (const component of components) store.perform(setModel(component, { name: component, sha256: component }));
  const studio = { framePixels: () => ({ pixels: new Uint8Array(64), width: 8, height: 8, covered: new Uint32Array() }) };
  const asked: unknown[] = [];
  const call = async (method: string, { pose }: { readonly pose: PoseNumbers }) => {
    if (method === 'isBrightNear') return true;
    const score = scores[pose.x] ?? 0.2;
    return { score, convinces: score >= 0.38 };
  };
  const first: Pick<FirstPoses, 'open' | 'find' | 'compare' | 'clickAgain'> = {
    open: async () => true,
    find: async (wanted, _, __, beforehand?: Beforehand) => {
      asked.push(['find', ...wanted, beforehand?.without.size, beforehand?.isBright]);
      amendAll(store);
      const places = wanted.flatMap((component) => (found[component] === undefined ? [] : [{ frameId: `f${found[component]}`, component }]));
      for (const place of places) set(store, place, 50, 'good', false);
      return places;
    },
    clickAgain: async (place, at) => {
      asked.push(['again', place.component, place.frameId, at]);
      if (again !== null) set(store, place, again, 'doubtful');
    },
    compare: async (component, _, known, click, bright) => {
      asked.push(['compare', component, known.frame, click.frame, click.place, bright]);
      return outcome;
    },
  };
  const leads = new ClickLeads({ store, studio } as never, first);
  const begin = () => leads.begin(components, { femur: { call }, tibia: { call } } as never, { signal: new AbortController().signal, cancel: () => undefined });
  const xs = (component: ComponentName = 'femur') => store.doc.frames.map(({ id }) => chosenCandidate(cellOf(store.doc, id, component))?.pose.x ?? null);
  return { store, begin, asked, xs };
}

/** What the film tells meanwhile moves what is there. */
function amendAll(store: Store): void {
  for (const { frameId, component, cell } of store.doc.cells.entries()) {
    if (cell.result) store.amend((doc) => withCell(doc, { frameId, component }, { ...cell, result: { ...cell.result! } }));
  }
}

/** What a click led to, or what the program found by itself. */
function set(store: Store, place: Place, x: number, word: 'good' | 'doubtful', isClick = true): void {
  const outline = { points: [], closed: true, unknownSides: [], laidBy: 'click' } as const;
  const verdict = { word, because: 'so it is' };
  const result: Posed = { kind: 'posed', from: 'outline', origin: 'o', candidates: [{ ...bare(poseOf(x)), judged: { misfit: 1, verdict } }], chosen: 0, reason: null, decided: true, verdict, onFrame: { film: null, ...(isClick && { clickedAt: framePoint(3, 4) }) } };
  const cell: Cell = { outline, result, resultOf: outline };
  store.perform({ label: 'click', apply: (doc) => withCell(doc, place, cell) });
}

const femur = (frame: number): Place => ({ frameId: `f${frame}`, component: 'femur' });

describe('clicks that do not convince', () => {
  it('lead where the film finds nothing without them, and the rest is looked for then', async () => {
    const { store, begin, asked, xs } = bench({ found: { tibia: 1 } }, ['femur', 'tibia']);
    set(store, femur(2), 7, 'doubtful');
    expect(await begin()).toEqual({ missing: [], told: [] });
    expect(asked).toEqual([['find', 'tibia', 'femur', 1, true]]);
    expect([xs(), xs('tibia')]).toEqual([[null, null, 7, null, null, null], [null, 50, null, null, null, null]]);
  });

  it('lead to others that are still missing', async () => {
    const { store, begin, asked } = bench({}, ['femur', 'tibia']);
    set(store, femur(2), 7, 'doubtful');
    expect(await begin()).toEqual({ missing: ['tibia'], told: [] });
    expect(asked).toEqual([['find', 'tibia', 'femur', 1, true], ['find', 'tibia', 0, true]]);
  });

  it('give way to what the film finds where that is better, and it is told', async () => {
    const { store, begin, asked, xs } = bench({ found: { femur: 4 }, outcome: 'outdone' });
    set(store, femur(2), 7, 'doubtful');
    const { told } = await begin();
    expect(told).toEqual([expect.stringContaining('Your click on the femur in frame 3 led to weaker edges than the film shows in frame 5')]);
    expect(asked).toEqual([['find', 'femur', 1, true], ['compare', 'femur', 4, 2, [3, 4], true]]);
    expect(xs()).toEqual([null, null, null, null, 50, null]);
    store.undo();
    expect(xs()).toEqual([null, null, 7, null, 50, null]);
  });

  it('give way without a word to the same', async () => {
    const { store, begin, xs } = bench({ found: { femur: 4 }, outcome: 'same' });
    set(store, femur(2), 7, 'doubtful');
    expect(await begin()).toEqual({ missing: [], told: [] });
    expect(xs()).toEqual([null, null, null, null, 50, null]);
  });

  it('take the place of what the film finds elsewhere, and are not compared again', async () => {
    const { store, begin, asked, xs } = bench({ found: { femur: 4 }, outcome: 'leads' });
    set(store, femur(2), 7, 'doubtful');
    await begin();
    expect(xs()).toEqual([null, null, 7, null, null, null]);
    await begin();
    expect(asked).toHaveLength(2);
  });

  it('come back where the film found something else in their own frame, and lead', async () => {
    const { store, begin, xs } = bench({ found: { femur: 2 }, outcome: 'leads' });
    set(store, femur(2), 7, 'doubtful');
    await begin();
    expect(xs()).toEqual([null, null, 7, null, null, null]);
  });

  it('stay out where the film found something better in their own frame', async () => {
    const { store, begin, xs } = bench({ found: { femur: 2 }, outcome: 'outdone' });
    set(store, femur(2), 7, 'doubtful');
    await begin();
    expect(xs()).toEqual([null, null, 50, null, null, null]);
  });

  it('are tried the best first, and the first that leads is what the others are compared with', async () => {
    const { store, begin, asked } = bench({ scores: { 7: 0.1, 8: 0.3 }, outcome: 'outdone' });
    set(store, femur(1), 7, 'doubtful');
    set(store, femur(3), 8, 'doubtful');
    await begin();
    expect(asked).toEqual([['find', 'femur', 2, true], ['compare', 'femur', 3, 1, [3, 4], true]]);
  });

  it('are clicked once more beside the other component where that is known, and the better of both stays', async () => {
    for (const [again, outcome, x] of [[9, [], 9], [8, [['find', 'femur', 1, true]], 8], [6, [['find', 'femur', 1, true]], 7]] as const) {
      const { store, begin, asked, xs } = bench({ scores: { 6: 0.1, 8: 0.3, 9: 0.5 }, again }, ['femur', 'tibia']);
      set(store, femur(2), 7, 'doubtful');
      set(store, { frameId: 'f2', component: 'tibia' }, 5, 'good');
      await begin();
      expect(asked).toEqual([['again', 'femur', 'f2', [3, 4]], ...outcome]);
      expect(xs()).toEqual([null, null, x, null, null, null]);
    }
  });

  it('are left alone where their poses lie on strong edges, a person set another, or they are good', async () => {
    for (const prepare of [
      (store: Store) => set(store, femur(2), 9, 'doubtful'),
      (store: Store) => (set(store, femur(2), 7, 'doubtful'), store.perform(setPoseByHand(femur(0), poseOf(1)))),
      (store: Store) => set(store, femur(2), 7, 'good'),
      (store: Store) => set(store, femur(2), 7, 'doubtful', false),
    ]) {
      const { store, begin, asked } = bench({ scores: { 9: 0.5 }, found: { femur: 4 }, outcome: 'outdone' });
      prepare(store);
      expect(await begin()).toEqual({ missing: [], told: [] });
      expect(asked).toEqual([]);
    }
  });
});
