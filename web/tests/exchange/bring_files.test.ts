import { describe, expect, it } from 'vitest';
import { setModel, startAnew } from '../../src/document/commands';
import { writeSession } from '../../src/document/session/session';
import { Store } from '../../src/document/store';
import { bringFiles } from '../../src/exchange/bring_files';
import { openSession } from '../../src/exchange/session_opener';
import type { Services } from '../../src/jobs/services';

describe('the files of work that comes back', () => {
  it('tell whoever draws once the models are there, too', async () => {
    const store = new Store();
    store.perform(setModel('tibia', { name: 'tray.stl', sha256: 't' }));
    const held: string[] = [];
    const asset = { name: 'tray.stl', sha256: 't', blob: new Blob(['solid']) };
    const studio = { meshOf: () => null, knowFrame: () => undefined, addModel: (sha256: string) => held.push(sha256) };
    const services = {
      store,
      studio,
      assets: { get: (sha256: string) => (sha256 === 't' ? asset : undefined), check: async () => true },
      decoder: { call: async () => ({ vertices: new Float64Array(), triangles: new Uint32Array() }) },
      shapeOf: async () => ({ component: null, remarks: [] }),
    };
    let drawn: readonly string[] = [];
    store.subscribe(() => (drawn = [...held]));
    const missing = await bringFiles(services as unknown as Services, store.doc, []);
    expect(missing).toEqual([]);
    expect(drawn).toEqual(['t']);
  });

  it('are brought but for a damaged one, which is told', async () => {
    const { store, services, held } = withDamagedFemur();
    const troubles: string[] = [];
    expect(await bringFiles(services, store.doc, troubles)).toEqual([]);
    expect(held).toEqual(['tray']);
    expect(troubles).toEqual([expect.stringMatching(/^femur\.stl: its copy in this browser is damaged/)]);
  });

  it('of a session are no reason not to open it', async () => {
    const { store, services, held } = withDamagedFemur();
    const parts = writeSession({ doc: store.doc, view: { frameIndex: 0, component: 'femur', overlayOpacity: 1 }, files: [], audit: null }, 'p', new Date(0));
    store.perform(startAnew());
    const remarks: string[] = [];
    await openSession(services, { name: 's.json', blob: new Blob(parts) }, remarks);
    expect(store.doc.components.femur.model?.name).toBe('femur.stl');
    expect(held).toEqual(['tray']);
    expect(remarks).toEqual([expect.stringContaining('femur.stl')]);
  });
});

/** Two models, of which the storage's copy of one is not what it was. */
function withDamagedFemur() {
  const store = new Store();
  store.perform(setModel('femur', { name: 'femur.stl', sha256: 'femur' }));
  store.perform(setModel('tibia', { name: 'tray.stl', sha256: 'tray' }));
  const held: string[] = [];
  const assets = {
    get: (sha256: string) => ({ sha256, name: `${sha256}.stl`, blob: new Blob(['x']) }),
    check: async ({ sha256 }: { sha256: string }) => sha256 !== 'femur',
  };
  const studio = { meshOf: () => null, addModel: (sha256: string) => void held.push(sha256) };
  const services = { store, assets, studio, decoder: { call: async () => ({}) }, shapeOf: async () => ({ component: null, remarks: [] }) } as unknown as Services;
  return { store, services, held };
}
