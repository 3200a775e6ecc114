import { describe, expect, it } from 'vitest';
import { setModel } from '../../src/document/commands';
import { Store } from '../../src/document/store';
import { bringFiles } from '../../src/exchange/bring_files';

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
      shapeOf: async () => null,
    };
    let drawn: readonly string[] = [];
    store.subscribe(() => (drawn = [...held]));
    const missing = await bringFiles(services as unknown as Parameters<typeof bringFiles>[0], store.doc);
    expect(missing).toEqual([]);
    expect(drawn).toEqual(['t']);
  });
});
