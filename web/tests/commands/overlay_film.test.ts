import { describe, expect, it, vi } from 'vitest';
import { addFrames, setCalibration, setModel } from '../../src/document/commands';
import { toggleChecked } from '../../src/document/marks';
import { bare, setPoseByHand, takeHandFit } from '../../src/document/hand_poses';
import { Store } from '../../src/document/store';
import type { OverlayFrame } from '../../src/workers/protocol/overlay';

const painted: OverlayFrame[] = [];
let onAdd: (index: number) => void = () => undefined;
vi.mock('../../src/workers/start', () => ({
  overlayWorker: () => ({
    dispose: () => undefined,
    call: async (method: string, input: OverlayFrame) => {
      if (method === 'add') painted.push(input), onAdd(input.index);
      return method === 'finish' ? new Blob() : null;
    },
  }),
}));

const frames = Array.from({ length: 4 }, (_, k) => ({ id: `f${k}`, name: `f${k}`, source: 's', indexInSource: k, width: 8, height: 8 }));
const poseOf = (x: number) => ({ x, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 });

function begin(): Store {
  const store = new Store();
  store.perform(addFrames(frames));
  store.perform(setCalibration({ name: 'c', text: 'c' }));
  store.perform(setModel('femur', { name: 'm', sha256: 'm' }));
  return store;
}

describe('a film of overlays', () => {
  it('is of one document, whatever is done to the poses while it is written', async () => {
    const { overlayLook, writeOverlayFilm } = await import('../../src/commands/overlay_film');
    const store = begin();
    for (let k = 0; k < 4; k++) store.perform(setPoseByHand({ frameId: `f${k}`, component: 'femur' }, poseOf(k)));
    const studio = { meshOf: () => ({ vertices: new Float64Array(), triangles: new Uint32Array() }), decoded: async () => ({ pixels: new Uint8Array(64), width: 8, height: 8 }) };
    onAdd = (index) => {
      if (index !== 1) return;
      store.perform(setPoseByHand({ frameId: 'f3', component: 'femur' }, poseOf(300)));
      store.perform(setCalibration({ name: 'another', text: 'another' }));
    };
    const look = overlayLook(store.doc, { columns: [], hasPlate: false, plate: new Float64Array(), otherSide: null, of: new Map(), impossible: new Map(), originsApart: null, waiting: 0 })!;
    await writeOverlayFilm({ store, studio } as never, look, 'pictures');
    expect(painted.map(({ poses, camera }) => [poses[0]?.pose.x, camera?.text])).toEqual([[0, 'c'], [1, 'c'], [2, 'c'], [3, 'c']]);
  });

  it('says of a doubtful pose that a person accepted it', async () => {
    const { notesOn } = await import('../../src/commands/overlay_film');
    const store = begin();
    const place = { frameId: 'f1', component: 'femur' } as const;
    store.perform(takeHandFit(place, { candidate: bare(poseOf(1)), reason: 'r', verdict: { word: 'doubtful', because: 'too deep' }, onFrame: null }));
    expect(notesOn(store.doc, 1)).toEqual(['Femur doubtful: too deep', 'Tibia: no pose']);
    store.perform(toggleChecked(place));
    expect(notesOn(store.doc, 1)).toEqual(['Femur: a person checked it; it was doubtful: too deep', 'Tibia: no pose']);
    expect(notesOn(store.doc, 9)).toEqual([]);
  });
});
