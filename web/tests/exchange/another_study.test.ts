import { describe, expect, it } from 'vitest';
import { Assets } from '../../src/document/assets';
import { addFrames } from '../../src/document/commands';
import { Store } from '../../src/document/store';
import { areOthers, stepAside } from '../../src/exchange/another_study';
import type { Incoming } from '../../src/exchange/incoming';

const files = (...names: string[]): Incoming[] => names.map((name) => ({ name, blob: new Blob([name]) }));

async function bench(...names: string[]) {
  const services = { store: new Store(), assets: new Assets() };
  for (const { name, blob } of files(...names)) {
    const { sha256 } = await services.assets.add(name, blob);
    const frame = { id: `${sha256}:0`, name, source: sha256, indexInSource: 0, width: 8, height: 8 };
    services.store.perform(addFrames([frame]));
  }
  return services;
}

describe('another study beside work', () => {
  it('is none where nothing is open', async () => {
    expect(await areOthers(await bench(), files('a.png'))).toBe(false);
  });

  it('is one of other frames, whatever they are named', async () => {
    const services = await bench('a.png');
    const sameName = [{ name: 'a.png', blob: new Blob(['another picture']) }];
    expect(await areOthers(services, sameName)).toBe(true);
  });

  it('is none where a frame of it is here already', async () => {
    const services = await bench('a.png', 'b.png');
    expect(await areOthers(services, files('b.png', 'c.png'))).toBe(false);
  });

  it('is none where it brings a file that could not be read before', async () => {
    const services = await bench('a.png');
    services.store.amend((doc) => ({ ...doc, unread: ['b.png'] }));
    expect(await areOthers(services, [{ name: 'b.png', blob: new Blob(['mended']) }])).toBe(false);
  });

  it('is none where the work waits for its own files', async () => {
    const services = await bench('a.png');
    const waiting = { store: services.store, assets: new Assets() };
    expect(await areOthers(waiting, files('b.png'))).toBe(false);
  });

  it('begins empty, and one button brings back what was open, which undo takes again', async () => {
    const services = await bench('a.png');
    const { store } = services;
    const before = store.doc;
    const { offer } = stepAside(services);
    expect(store.doc.frames).toHaveLength(0);
    offer.take();
    expect(store.doc).toEqual(before);
    store.undo();
    expect(store.doc.frames).toHaveLength(0);
    store.undo();
    expect(store.doc).toEqual(before);
  });
});
