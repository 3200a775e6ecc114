import { afterEach, describe, expect, it, vi } from 'vitest';
import { EMPTY_DOC } from '../../src/document/types';
import { Store } from '../../src/document/store';
import { openDemonstration } from '../../src/exchange/demonstration';
import type { Services } from '../../src/jobs/services';
import { texts } from '../../src/texts/texts';
import { Aborted } from '../../src/workers/bridge';

/** A server that never answers. */
function silent(_: unknown, { signal }: { signal: AbortSignal }): Promise<never> {
  return new Promise((_resolve, reject) => signal.addEventListener('abort', () => reject(signal.reason)));
}

describe('the demonstration', () => {
  afterEach(() => vi.unstubAllGlobals());

  it('is a job while it is fetched, which can be called off', async () => {
    vi.stubGlobal('fetch', silent);
    const store = new Store();
    const opened = openDemonstration({ store } as unknown as Services);
    const [job] = store.ui.jobs;
    expect(job?.title).toBe(texts.said.demonstration);
    job?.cancel?.();
    await expect(opened).rejects.toBeInstanceOf(Aborted);
    expect(store.ui.jobs).toEqual([]);
    expect(store.doc).toBe(EMPTY_DOC);
  });
});
