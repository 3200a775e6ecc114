import { describe, expect, it } from 'vitest';
import { OWN_AXES, setAxes } from '../../src/document/axes';
import { bare, setPoseByHand } from '../../src/document/hand_poses';
import { toggleChecked } from '../../src/document/marks';
import { addFrames, addPoint, setCalibration, setModel, withCell } from '../../src/document/commands';
import { currentRefusal, Store } from '../../src/document/store';
import { type Axes, cellOf } from '../../src/document/types';
import { framePoint } from '../../src/geometry/points';
import { OneClick } from '../../src/tracing/one_click';
import type { OneClickFacts, OneClickInput } from '../../src/workers/protocol/one_click';
import { Aborted, type CallOptions } from '../../src/workers/bridge';

const FRAME = { id: 'f', name: 'f', source: 's', indexInSource: 0, width: 8, height: 8 };
const settle = () => new Promise((resolve) => setTimeout(resolve));

/** Ready for clicks, and a worker that answers when the test says so. */
function bench() {
  const store = new Store();
  store.perform(addFrames([FRAME]));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
  let told: Partial<OneClickFacts> = {};
  const asked: { input: OneClickInput; report: (fraction: number) => void; answer: () => Promise<unknown> }[] = [];
  const call = (_: string, input: OneClickInput, { signal, onProgress }: CallOptions<{ fraction: number }>) =>
    new Promise<OneClickFacts>((resolve, reject) => {
      signal?.addEventListener('abort', () => reject(new Aborted()));
      const facts = { outlines: [Float64Array.of(1, 1, 5, 1, 5, 5)], supports: [], corrected: false, bright: false, match: null, sentence: 'Found.', ...told };
      const report = (fraction: number) => onProgress?.({ fraction });
      asked.push({ input, report, answer: () => (resolve(facts), settle()) });
    });
  let units: readonly number[] = [];
  const studio = { framePixels: () => ({ pixels: new Uint8Array(64), width: 8, height: 8, covered: new Uint32Array() }), suspectedUnitsOf: () => units };
  const oneClick = new OneClick({ store, studio } as never, { call } as never, { ready: async () => undefined });
  const click = (column: number) => void oneClick.ask([framePoint(column, 1)], { frameId: 'f', component: store.ui.component }, false);
  const outlineOf = (component: 'femur' | 'tibia') => cellOf(store.doc, 'f', component).outline;
  return { store, asked, click, outlineOf, tell: (facts: Partial<OneClickFacts>) => void (told = facts), suspect: (mm: number) => void (units = [mm]) };
}

describe('one click', () => {
  it('waits for its turn, and sees what came of the clicks before', async () => {
    const { store, asked, click, outlineOf } = bench();
    click(1);
    store.selectComponent('tibia');
    click(2);
    await settle();
    expect(store.ui.jobs.map(({ title }) => title)).toEqual(['Femur of frame 1 by one click', 'Tibia of frame 1 by one click']);
    expect(asked.map(({ input }) => input.component)).toEqual(['femur']);
    await asked[0]!.answer();
    await settle();
    expect(asked[1]?.input).toMatchObject({ component: 'tibia', avoid: Float64Array.of(1, 1, 5, 1, 5, 5) });
    await asked[1]!.answer();
    expect([outlineOf('femur'), outlineOf('tibia')].map((outline) => outline?.closed)).toEqual([true, true]);
    expect(store.ui.jobs).toEqual([]);
  });

  it('into a pose that a person has checked asks once more', async () => {
    const { store, asked, click } = bench();
    const place = { frameId: 'f', component: 'femur' } as const;
    const pose = { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };
    store.perform(setPoseByHand(place, pose));
    store.perform(toggleChecked(place));
    click(1);
    await settle();
    expect([asked.length, store.ui.notice?.text]).toEqual([0, 'You have checked this femur: click again to find it anew.']);
    // Another cell is none of its business.
    store.selectComponent('tibia');
    click(2);
    await settle();
    expect(asked.length).toBe(1);
    await asked[0]!.answer();
    store.selectComponent('femur');
    click(1);
    await settle();
    expect(asked.length).toBe(1);
    click(1);
    await settle();
    expect(asked.length).toBe(2);
  });

  it('says of a pose what its verdict says, so that nothing beside it says otherwise', async () => {
    const { store, asked, click, tell } = bench();
    const candidates = [bare({ x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 })];
    tell({ sentence: 'Another pose explains the frame nearly as well.', match: { candidates, reason: 'r', decided: true, refusal: null, verdict: { word: 'good', because: 'the edges lie on the outline' } } as never });
    click(1);
    await settle();
    await asked[0]!.answer();
    expect(store.ui.notice?.text).toBe('Femur: Good, the edges lie on the outline.');
  });

  it('takes back what it said of a pose as soon as that has another verdict, and nothing that was said since', async () => {
    const { store, asked, click, tell } = bench();
    store.setLibrary('femur', { state: 'ready', key: 'k', views: 1, bytes: 1, seconds: 1 });
    const candidates = [bare({ x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 })];
    tell({ match: { candidates, reason: 'r', decided: true, refusal: null, verdict: { word: 'doubtful', because: 'another pose fits as well' } } as never });
    const judge = (word: 'good' | 'doubtful' | null) =>
      store.amend((doc) => {
        const cell = cellOf(doc, 'f', 'femur');
        if (cell.result?.kind !== 'posed') throw new Error('no pose');
        return withCell(doc, { frameId: 'f', component: 'femur' }, { ...cell, result: { ...cell.result, verdict: word && { word, because: 'b' } } });
      });
    for (const spoken of ['Femur: Doubtful, another pose fits as well.', 'Something else.']) {
      click(1);
      await settle();
      await asked.at(-1)!.answer();
      if (spoken === 'Something else.') store.say('info', spoken);
      judge(null);
      judge('doubtful');
      expect(store.ui.notice?.text).toBe(spoken);
      judge('good');
      expect(store.ui.notice?.text).toBe(spoken === 'Something else.' ? spoken : undefined);
    }
  });

  it('asks first for the unit of the model where that is open, as soon as nothing is found', async () => {
    const failed = async (suspected: boolean) => {
      const { store, asked, click, tell, suspect } = bench();
      if (suspected) suspect(1000);
      store.setLibrary('femur', { state: 'ready', key: 'k', views: 1, bytes: 1, seconds: null });
      tell({ sentence: 'Nothing of its size is set off there.', match: { candidates: [], reason: null, decided: false, refusal: 'nothing', verdict: null } as never });
      click(1);
      await settle();
      await asked[0]!.answer();
      const { result } = cellOf(store.doc, 'f', 'femur');
      return result?.kind === 'failed' ? result.sentence : null;
    };
    expect(await failed(false)).toBe('Nothing of its size is set off there.');
    expect(await failed(true)).toMatch(/^Which unit is m in\? .* Nothing of its size is set off there\.$/);
  });

  it('into the same cell takes the place of the one before, whose late progress shows nothing', async () => {
    const { store, asked, click } = bench();
    click(1);
    await settle();
    click(2);
    await settle();
    await settle();
    expect(store.ui.jobs).toHaveLength(1);
    asked[0]!.report(0.5);
    expect(store.ui.jobs).toHaveLength(1);
    expect([...(asked[1]?.input.prompt ?? [])]).toEqual([2, 1]);
    await asked[1]!.answer();
    expect(store.ui.jobs).toEqual([]);
  });

  it('into a tray beside a femur whose pose is reliable is told of that, and of the axes of both', async () => {
    const { store, asked, click, tell } = bench();
    const own: Axes = { directions: OWN_AXES, from: 'shape', told: 'not the front' };
    for (const name of ['femur', 'tibia'] as const) {
      store.perform(setModel(name, { name: 'm', sha256: name }));
      store.perform(setAxes(name, name === 'tibia' ? own : { ...own, told: 'all' }));
      store.setLibrary(name, { state: 'ready', key: 'k', views: 1, bytes: 1, seconds: 1 });
    }
    const pose = { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };
    const candidates = [{ ...bare(pose), residual: 0.4 }];
    tell({ match: { candidates, reason: 'r', decided: true, refusal: null, verdict: { word: 'good', because: 'b' } } as never });
    click(1);
    await settle();
    expect(asked[0]?.input.other).toBeNull();
    await asked[0]!.answer();
    store.selectComponent('tibia');
    click(2);
    await settle();
    await settle();
    expect(asked[1]?.input.other).toEqual({
      pose,
      axes: { directions: OWN_AXES, front: true },
      own: { directions: OWN_AXES, front: false },
    });
    store.perform(setAxes('tibia', { ...own, told: 'no signs' }));
    click(3);
    await settle();
    await settle();
    expect(asked.at(-1)?.input.other).toBeNull();
  });

  it('can be called off while it waits, and the next one goes on', async () => {
    const { store, asked, click, outlineOf } = bench();
    click(1);
    store.selectComponent('tibia');
    click(2);
    await settle();
    store.ui.jobs[1]?.cancel();
    await settle();
    expect(store.ui.jobs).toHaveLength(1);
    await asked[0]!.answer();
    await settle();
    expect(asked).toHaveLength(1);
    expect(outlineOf('tibia')).toBeNull();
  });

  it('what was refused stands in the cell, too, until that or its model changes', async () => {
    const { store, click } = bench();
    store.perform(setCalibration(null));
    click(1);
    await settle();
    await settle();
    expect(store.ui.notice?.kind).toBe('error');
    expect(currentRefusal(store.state)).toBe(store.ui.notice?.text);
    store.selectComponent('tibia');
    expect(currentRefusal(store.state)).toBeNull();
    store.selectComponent('femur');
    store.quiet();
    expect(currentRefusal(store.state)).toMatch(/needs a calibration/);
    store.perform(setModel('tibia', { name: 'm', sha256: 'other' }));
    expect(currentRefusal(store.state)).toMatch(/needs a calibration/);
    store.perform(setModel('femur', { name: 'm_mm.stl', sha256: 'written again' }));
    expect(currentRefusal(store.state)).toBeNull();
    click(1);
    await settle();
    await settle();
    expect(currentRefusal(store.state)).toMatch(/needs a calibration/);
    store.perform(addPoint({ frameId: store.doc.frames[0]!.id, component: 'femur' }, framePoint(1, 1)));
    expect(currentRefusal(store.state)).toBeNull();
  });

  it('waits for a library that is being built', async () => {
    const { store, asked, click } = bench();
    store.setLibrary('femur', { state: 'building', key: 'k' });
    click(1);
    await settle();
    expect(asked).toEqual([]);
    store.setLibrary('femur', { state: 'ready', key: 'k', views: 1, bytes: 1, seconds: 1 });
    await settle();
    expect(asked[0]?.input.withModel).toBe(true);
  });
});
