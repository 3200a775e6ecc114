import { expect, it } from 'vitest';
import { Assets } from '../../src/document/assets';
import { addFrames } from '../../src/document/commands';
import { readSession } from '../../src/document/session/session';
import { Store } from '../../src/document/store';
import { saveSession } from '../../src/exchange/saver';
import { ClearedBlob } from '../cleared_blob';

/** Of its three files one is at hand, one was cleared from the browser's storage, and one was never opened. */
async function work() {
  const store = new Store();
  const assets = new Assets();
  const { sha256 } = await assets.add('here.png', new Blob([Uint8Array.of(1, 2, 3)]));
  assets.keep({ name: 'cleared.png', sha256: 'cleared', blob: new ClearedBlob() });
  const sources = { here: sha256, cleared: 'cleared', never: 'never' };
  const frames = Object.entries(sources).map(([id, source]) => ({ id, name: `${id}.png`, source, indexInSource: 0, width: 9, height: 9 }));
  store.perform(addFrames(frames));
  return { store, assets };
}

it('a session includes the files that are at hand, and names those that it is without', async () => {
  const { parts, without } = await saveSession(await work(), true);
  expect(without).toEqual(['cleared.png', 'never.png']);
  const { files } = readSession(parts.join(''));
  expect(files.map(({ name, bytes }) => [name, bytes && [...bytes]])).toEqual([['here.png', [1, 2, 3]], ['cleared.png', null], ['never.png', null]]);
});

it('a session that was to have no files is without none', async () => {
  expect((await saveSession(await work(), false)).without).toEqual([]);
});
