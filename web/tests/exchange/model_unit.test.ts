import { describe, expect, it } from 'vitest';
import { Assets } from '../../src/document/assets';
import { setAxes } from '../../src/document/axes';
import { setModel } from '../../src/document/commands';
import { Store } from '../../src/document/store';
import { takeInMillimetres } from '../../src/exchange/model_unit';
import { stlOf } from '../../src/exchange/stl';
import { readStudy } from '../../src/exchange/study_file';
import { writeStudy } from '../../src/exchange/study_text';
import type { Axes } from '../../src/document/types';
import { type Directions, directionsFromWords } from '../../src/geometry/axes';
import type { Services } from '../../src/jobs/services';

const MESH = { vertices: Float32Array.of(0, 0, 0, 0.06, 0, 0, 0, 0.05, 0.01), triangles: Uint32Array.of(0, 2, 1) };

function bench() {
  const store = new Store();
  const held = new Map<string, unknown>([['metres', MESH]]);
  const studio = { meshOf: (sha256: string) => held.get(sha256) ?? null, addModel: (sha256: string, mesh: unknown) => void held.set(sha256, mesh) };
  const decoder = { call: async (_: string, { bytes }: { bytes: Uint8Array<ArrayBuffer> }) => bytes };
  const services = { store, studio, decoder, assets: new Assets(), shapeOf: async () => ({ component: null, remarks: [] }) } as unknown as Services;
  store.perform(setModel('tibia', { name: 'tray.size 4.ply', sha256: 'metres' }));
  return { store, services, held };
}

describe('a model in another unit', () => {
  it('is written again in millimetres, and one step back brings it back', async () => {
    const { store, services, held } = bench();
    await takeInMillimetres(services, 'tibia', 1000);
    const { model } = store.doc.components.tibia;
    expect(model?.name).toBe('tray.size 4_mm.stl');
    expect(held.get(model!.sha256)).toEqual(stlOf(MESH, 1000));
    expect(store.ui.notice?.text).toContain('read in metres');
    store.undo();
    expect(store.doc.components.tibia.model?.sha256).toBe('metres');
  });

  it('is named by a study with the file that it came from and its unit, which commands read too; its stated axes stay', async () => {
    const { store, services } = bench();
    const axes: Axes = { directions: directionsFromWords('y z x') as Directions, from: 'study', told: 'all' };
    store.perform(setAxes('tibia', axes));
    await takeInMillimetres(services, 'tibia', 1000);
    expect(store.doc.components.tibia.axes).toEqual(axes);
    const { parts } = readStudy(writeStudy(store.doc));
    expect(parts).toMatchObject([{ component: 'tibia', model: 'tray.size 4.ply', unit: 'm', axes: { told: 'all' } }]);
  });

  it('has its corners where a binary STL file has them, in the order of its triangles', () => {
    const bytes = stlOf(MESH, 1000);
    const view = new DataView(bytes.buffer);
    expect(bytes.length).toBe(84 + 50);
    expect(view.getUint32(80, true)).toBe(1);
    const corners = Array.from({ length: 9 }, (_, at) => Math.round(view.getFloat32(96 + 4 * at, true)));
    expect(corners).toEqual([0, 0, 0, 0, 50, 10, 60, 0, 0]);
  });

  it('that is gone stays gone', async () => {
    const { store, services } = bench();
    await takeInMillimetres(services, 'femur', 1000);
    expect(store.doc.components.femur.model).toBeNull();
  });
});
