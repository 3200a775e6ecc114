import { expect, it, vi } from 'vitest';
import { Assets } from '../../src/document/assets';
import { frameDecoder } from '../../src/films/decoding';
import { work } from '../../src/workers/activity';
import { ClearedBlob } from '../cleared_blob';

it('a frame of a file that the browser cleared from its storage is refused by name, not waited for', async () => {
  const assets = new Assets();
  assets.keep({ name: 'f.png', sha256: 'digest', blob: new ClearedBlob() });
  // Other files' tests have begun work that never ends.
  const over = vi.fn();
  vi.spyOn(work, 'begin').mockReturnValueOnce(over);
  const decode = frameDecoder(assets, { call: () => Promise.reject(new Error('the worker was asked')) });
  await expect(decode({ sha256: 'digest', index: 0 }, new AbortController().signal)).rejects.toThrow(/no copy any more of f\.png/);
  expect(over).toHaveBeenCalledOnce();
});
