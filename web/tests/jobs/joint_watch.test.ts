import { describe, expect, it, vi } from 'vitest';
import { plainDoc, readDoc } from '../../src/document/session/session';
import { setAxes } from '../../src/document/axes';
import { addFrames, setCalibration, setModel, withCell } from '../../src/document/commands';
import { toggleFlagged } from '../../src/document/marks';
import { Store } from '../../src/document/store';
import { type Axes, type Calibration, type Candidate, cellOf, type Posed, verdictAlone, verdictOf } from '../../src/document/types';
import { type Directions, directionsFromWords } from '../../src/geometry/axes';
import { doubtsOf } from '../../src/results/doubts';
import { surroundingsOf } from '../../src/results/surroundings';
import { COMPONENT_NAMES, type ComponentName } from '../../src/terms/component';
import { JointWatch } from '../../src/jobs/joint_watch';
import type { JointProtocol } from '../../src/workers/protocol/joint';

type Asked = JointProtocol['lyingBeside']['input'];

const AXES: Axes = { directions: directionsFromWords('x y z') as Directions, from: 'shape', told: 'all' };

function posed(z: number, word: 'good' | 'doubtful' = 'good'): Posed {
  const judged = { misfit: 0.4, verdict: { word, because: 'it fits' } } as const;
  const candidate: Candidate = { pose: { x: 0, y: 0, z, zRot: 0, xRot: 0, yRot: 0 }, unmatched: 1, drawn: 1, residual: 0.3, deviations: null, judged };
  return { kind: 'posed', from: 'outline', origin: 'k', candidates: [candidate], chosen: 0, reason: null, decided: true, verdict: judged.verdict };
}

/** Three frames; a worker that tells those in which a tray lies 20 mm beside its femur. */
function bench() {
  const store = new Store();
  const asked: Asked[] = [];
  const call = async (_: string, input: Asked) => {
    asked.push(input);
    return input.frames.map(({ femur, tibia }) => {
      if (!femur || !tibia || Math.abs(femur.pose.z - tibia.pose.z) <= 20) return null;
      const isBeyondFlipping = tibia.pose.z < -2000;
      return { sentence: isBeyondFlipping ? 'farther than the tray is wide' : tibia.pose.z < -1040 ? 'are the pictures mirrored, by more?' : 'are the pictures mirrored?', isBeyondFlipping };
    });
  };
  const studio = { meshOf: () => ({ vertices: new Float32Array(), triangles: new Uint32Array() }) };
  new JointWatch({ store, studio } as unknown as ConstructorParameters<typeof JointWatch>[0], { call } as unknown as ConstructorParameters<typeof JointWatch>[1]);
  const frame = (id: string) => ({ id, name: id, source: id, indexInSource: 0, width: 10, height: 10 });
  store.perform(addFrames(['a', 'b', 'c'].map(frame)));
  for (const component of COMPONENT_NAMES) {
    store.perform(setModel(component, { name: `${component}.stl`, sha256: component }));
    store.perform(setAxes(component, AXES));
  }
  const put = (frameId: string, component: ComponentName, result: Posed | null) =>
    store.amend((doc) => withCell(doc, { frameId, component }, { outline: null, result, resultOf: null }));
  const word = (frameId: string, component: ComponentName) => verdictOf(cellOf(store.doc, frameId, component).result)?.word;
  return { store, asked, put, word };
}

describe('joint watch', () => {
  it('makes both poses doubtful, says why once, and takes it back when they are right', async () => {
    const { store, put, word } = bench();
    put('a', 'femur', posed(-1000));
    put('a', 'tibia', posed(-1030));
    put('b', 'femur', posed(-1000));
    await vi.waitFor(() => expect([word('a', 'femur'), word('a', 'tibia'), word('b', 'femur')]).toEqual(['doubtful', 'doubtful', 'good']));
    expect(store.ui.notice?.text).toBe('Are the pictures mirrored?');
    expect(doubtsOf(store.doc).map(({ place }) => place.component)).toEqual(['femur', 'tibia']);
    put('a', 'tibia', posed(-1001));
    await vi.waitFor(() => expect(word('a', 'femur')).toBe('good'));
    expect(cellOf(store.doc, 'a', 'femur').result).not.toHaveProperty('aside');
    expect(store.ui.notice).toBeNull();
  });

  it('makes no good pose doubtful for one that is astray and doubtful by itself, farther off than mirrored pictures leave it', async () => {
    const { store, put, word } = bench();
    put('a', 'femur', posed(-1000));
    put('a', 'tibia', posed(-3000, 'doubtful'));
    put('b', 'femur', posed(-1000));
    put('b', 'tibia', posed(-3000));
    put('c', 'femur', posed(-1000, 'doubtful'));
    put('c', 'tibia', posed(-1030));
    await vi.waitFor(() => expect(COMPONENT_NAMES.map((component) => word('b', component))).toEqual(['doubtful', 'doubtful']));
    const asides = ['a', 'b', 'c'].map((id) => COMPONENT_NAMES.map((component) => 'aside' in cellOf(store.doc, id, component).result!));
    expect(asides).toEqual([[false, true], [true, true], [true, true]]);
    expect(word('a', 'femur')).toBe('good');
  });

  it('does not leave it said that a pose is good, and says it behind what following a film came to', async () => {
    const said = async (of: 'pose' | 'film' | undefined, expected: string) => {
      const { store, put } = bench();
      store.say('info', 'Femur: Good.', undefined, of);
      put('a', 'femur', posed(-1000));
      put('a', 'tibia', posed(-1030));
      await vi.waitFor(() => expect(cellOf(store.doc, 'a', 'femur').result).toHaveProperty('aside'));
      expect(store.ui.notice?.text).toBe(expected);
    };
    await said('pose', 'Are the pictures mirrored?');
    await said('film', 'Femur: Good. Are the pictures mirrored?');
    await said(undefined, 'Femur: Good.');
  });

  it('is not taken back by a film that was followed to no good pose, and is by good ones', async () => {
    const { store, put, word } = bench();
    put('a', 'femur', posed(-1000));
    put('a', 'tibia', posed(-1030));
    await vi.waitFor(() => expect(word('a', 'femur')).toBe('doubtful'));
    expect(store.doc.kneeDoubt?.sentence).toBe('are the pictures mirrored?');
    const unsure: Posed = { ...posed(-1001), verdict: { word: 'doubtful', because: 'ambiguous' } };
    put('a', 'tibia', unsure);
    store.say('info', 'Followed 1 cell.', undefined, 'film');
    await vi.waitFor(() => expect(store.ui.notice?.text).toBe('Followed 1 cell. Are the pictures mirrored?'));
    expect(store.doc.kneeDoubt?.sentence).toBe('are the pictures mirrored?');
    put('a', 'tibia', posed(-1050));
    await vi.waitFor(() => expect(store.doc.kneeDoubt?.sentence).toBe('are the pictures mirrored, by more?'));
    expect(store.ui.notice?.text).toBe('Followed 1 cell. Are the pictures mirrored, by more?');
    put('a', 'tibia', posed(-1001));
    await vi.waitFor(() => expect(store.doc.kneeDoubt).toBeNull());
    expect(store.ui.notice?.text).toBe('Followed 1 cell.');
  });

  it('tells it also of work that came back, and keeps it over a step back', async () => {
    const { store, put } = bench();
    put('a', 'femur', posed(-1000));
    store.perform(toggleFlagged({ frameId: 'a', component: 'femur' }));
    put('a', 'tibia', posed(-1030));
    await vi.waitFor(() => expect(store.doc.kneeDoubt).not.toBeNull());
    store.undo();
    expect(store.doc.kneeDoubt?.sentence).toBe('are the pictures mirrored?');
    const unsure: Posed = { ...posed(-1001), verdict: { word: 'doubtful', because: 'ambiguous' } };
    put('a', 'tibia', unsure);
    await vi.waitFor(() => expect(cellOf(store.doc, 'a', 'femur').result).not.toHaveProperty('aside'));
    const kept = JSON.stringify(plainDoc(store.doc));
    const again = bench();
    again.store.amend(() => readDoc(JSON.parse(kept), 'work'));
    await vi.waitFor(() => expect(again.store.ui.notice?.text).toBe('Are the pictures mirrored?'));
    expect(again.store.doc.kneeDoubt?.sentence).toBe('are the pictures mirrored?');
  });

  it('leaves what is worked out from poses to what they are by themselves', async () => {
    const { store, put, word } = bench();
    put('a', 'femur', posed(-1000));
    put('a', 'tibia', posed(-1030));
    await vi.waitFor(() => expect(word('a', 'femur')).toBe('doubtful'));
    expect(verdictAlone(cellOf(store.doc, 'a', 'femur').result)?.word).toBe('good');
    expect(surroundingsOf(store.doc, 'b', 'femur').neighbours).toHaveLength(1);
    expect(store.state.history.past).toHaveLength(5);
  });

  it('asks once for what does not change, and takes all back where a component goes', async () => {
    const { store, asked, put, word } = bench();
    put('a', 'femur', posed(-1000));
    expect(asked).toHaveLength(0);
    put('a', 'tibia', posed(-1030));
    await vi.waitFor(() => expect(word('a', 'tibia')).toBe('doubtful'));
    store.show({});
    await new Promise((resolve) => setTimeout(resolve, 5));
    expect(asked).toHaveLength(1);
    put('a', 'femur', null);
    await vi.waitFor(() => expect(word('a', 'tibia')).toBe('good'));
    expect(asked).toHaveLength(1);
  });
});

describe('a film that is looked at as if it were flipped', () => {
  /** Two frames with a calibration; a worker that wants the femur in the first, and then tells that all is mirrored. */
  function filmed(frames: readonly string[]) {
    const store = new Store();
    const called: string[] = [];
    let seen = 0;
    const call = async (name: string, input: never) => {
      called.push(name);
      if (name === 'beginFlipped') return { component: 'femur', frame: 0 };
      if (name === 'lookFlipped') return (seen++, null);
      const { frames } = input as Asked;
      return frames.map(({ femur, tibia }) => (femur && tibia && seen > 0 ? { sentence: 'both fit better flipped: are the pictures mirrored?', isBeyondFlipping: false } : null));
    };
    const framePixels = async () => ({ pixels: new Uint8Array(4), width: 2, height: 2, covered: new Uint32Array() });
    const studio = { meshOf: () => ({ vertices: new Float32Array(), triangles: new Uint32Array() }), framePixels };
    new JointWatch({ store, studio } as unknown as ConstructorParameters<typeof JointWatch>[0], { call } as unknown as ConstructorParameters<typeof JointWatch>[1]);
    store.perform(addFrames(frames.map((id) => ({ id, name: id, source: id, indexInSource: 0, width: 10, height: 10 }))));
    store.perform(setCalibration({ name: 'calibration.txt', text: 'JT_INTCALIB', camera: null } as unknown as Calibration));
    for (const component of COMPONENT_NAMES) {
      store.perform(setModel(component, { name: `${component}.stl`, sha256: component }));
      store.perform(setAxes(component, AXES));
    }
    const put = (frameId: string) =>
      COMPONENT_NAMES.forEach((component) => store.amend((doc) => withCell(doc, { frameId, component }, { outline: null, result: posed(-1000), resultOf: null })));
    const looks = () => called.filter((name) => name === 'lookFlipped').length;
    return { store, put, looks };
  }

  it('is doubtful where the core says so, is not looked at again for nothing, and is once more frames are known', async () => {
    const { store, put, looks } = filmed(['a', 'b']);
    put('a');
    await vi.waitFor(() => expect(verdictOf(cellOf(store.doc, 'a', 'femur').result)?.because).toMatch(/flipped/));
    store.show({});
    await new Promise((resolve) => setTimeout(resolve, 5));
    expect(looks()).toBe(1);
    put('b');
    await vi.waitFor(() => expect(looks()).toBe(2));
    put('a');
    await vi.waitFor(() => expect(looks()).toBe(3));
  });

  it('is looked at before what was told of work that came back is taken back', async () => {
    const { store, put } = filmed(['a']);
    put('a');
    await vi.waitFor(() => expect(store.doc.kneeDoubt).not.toBeNull());
    const kept = JSON.stringify(plainDoc(store.doc));
    const again = filmed([]);
    const told: (string | null)[] = [];
    again.store.subscribe(() => told.push(verdictOf(cellOf(again.store.doc, 'a', 'femur').result)?.because ?? null));
    again.store.amend(() => readDoc(JSON.parse(kept), 'work'));
    await vi.waitFor(() => expect(again.store.ui.notice?.text).toMatch(/flipped/));
    expect(again.looks()).toBe(1);
    expect(new Set(told)).toEqual(new Set(['both fit better flipped: are the pictures mirrored?']));
  });

  it('waits until a hand lets go of the model', async () => {
    const { store, put, looks } = filmed(['a']);
    store.show({ tool: 'pose' });
    put('a');
    await new Promise((resolve) => setTimeout(resolve, 5));
    expect(looks()).toBe(0);
    store.show({ tool: 'edit' });
    await vi.waitFor(() => expect(looks()).toBe(1));
  });
});
