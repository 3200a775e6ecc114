import { beforeEach, describe, expect, it } from 'vitest';
import { Assets } from '../../src/document/assets';
import { addFrames } from '../../src/document/commands';
import { SESSION_VERSION, plainDoc } from '../../src/document/session/session';
import { Store } from '../../src/document/store';
import { Cells } from '../../src/document/cells';
import type { Doc } from '../../src/document/types';
import type { Services } from '../../src/jobs/services';
import type { Keeper } from '../../src/keep/keeper';
import { restoreWork } from '../../src/keep/restore';
import type { KeptWork, Shelf } from '../../src/keep/shelf';

const FILE = { sha256: 'digest', name: 'f.png' };

function kept(): KeptWork {
  const store = new Store();
  store.perform(addFrames([{ id: 'f', name: FILE.name, source: FILE.sha256, indexInSource: 0, width: 9, height: 9 }]));
  store.amend((doc) => ({ ...doc, name: 'knee', cells: Cells.NONE }));
  const { cells: _, ...document } = plainDoc(store.doc);
  const view = { frameIndex: 0, component: 'femur', overlayOpacity: 1 } as const;
  return { id: 'w', name: 'knee', frames: 1, savedAt: 1, putAside: false, program: 'p', version: SESSION_VERSION, document, view, files: [FILE] };
}

/** A page, and a storage that is cleared after so many questions to it. */
function bench(answers: number) {
  const store = new Store();
  const assets = new Assets();
  const adopted: { doc: Doc; filesAtHand: boolean }[] = [];
  let asked = 0;
  const isThere = () => asked++ < answers;
  const shelf = {
    work: async () => (isThere() ? kept() : null),
    cells: async () => (isThere() ? {} : {}),
    files: async () => (isThere() ? [{ ...FILE, blob: new Blob([Uint8Array.of(1)]) }] : []),
  };
  const keeper = {
    shelf: async () => shelf as unknown as Shelf,
    adopt: (doc: Doc) => adopted.push({ doc, filesAtHand: assets.get(FILE.sha256) !== undefined }),
  } as unknown as Keeper;
  const services = { store, assets, studio: { knowFrame: () => undefined } } as unknown as Services;
  return { store, services, keeper, adopted };
}

let work: KeptWork;
beforeEach(() => void (work = kept()));

describe('work that comes back', () => {
  it('has its files at hand before the document names them', async () => {
    const { store, services, keeper, adopted } = bench(Infinity);
    await restoreWork(services, keeper, work);
    expect(store.doc.name).toBe('knee');
    expect(adopted).toMatchObject([{ filesAtHand: true }]);
  });

  it.each([0, 1, 2])('is none where the browser clears the rest of it after %d answers, and that is said', async (answers) => {
    const { store, services, keeper, adopted } = bench(answers);
    await restoreWork(services, keeper, work);
    expect(adopted).toEqual([]);
    expect(store.doc.frames).toEqual([]);
    expect(store.ui.notice?.text).toMatch(/knee .* the browser cleared its storage/);
  });

  it('is back though a copy of a file of it is damaged, and that is said alone', async () => {
    const { store, services, keeper } = bench(Infinity);
    const model = { name: 'femur.stl', sha256: 'other' };
    const assets = { get: () => ({ ...model, blob: new Blob() }), keep: () => undefined, check: async () => false };
    const { components } = work.document as unknown as Doc;
    const document = { ...work.document, components: { ...components, femur: { ...components.femur, model } } };
    const studio = { ...services.studio, meshOf: () => null };
    await restoreWork({ ...services, assets, studio } as unknown as Services, keeper, { ...work, document });
    expect(store.doc.components.femur.model?.name).toBe('femur.stl');
    expect(store.ui.log.map(({ text }) => text)).toEqual([expect.stringMatching(/^knee is back/), expect.stringMatching(/^femur\.stl: its copy in this browser is damaged/)]);
  });
});
