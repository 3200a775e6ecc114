import { describe, expect, it } from 'vitest';
import { withSoFar } from '../../src/document/followed';
import { plainDoc, readDoc } from '../../src/document/session/session';
import { takeInMillimetres } from '../../src/exchange/model_unit';
import { at, pageOfFiles, unreadable } from './page_of_files';

describe('one file of many', () => {
  it.each([2, 20])('that cannot be read is named, and the %d others are opened all the same', async (others) => {
    const { frames, said, open } = pageOfFiles();
    await open(unreadable('/study/broken.png'), ...Array.from({ length: others }, (_, k) => at(`/study/f${k}.png`)));
    expect(frames()).toHaveLength(others);
    expect(said()).toContain('broken.png: The requested file could not be read');
  });
});

describe('a model that was written again in millimetres', () => {
  it('is known when its file comes again, also after a session, and what was followed with it stays', async () => {
    const { store, services, open } = pageOfFiles();
    const files = [at('/study/c.txt'), at('/study/femur.stl'), at('/study/f1.png')];
    await open(...files);
    await takeInMillimetres(services, 'femur', 10);
    const pose = { x: 1, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };
    store.amend((doc) => withSoFar(doc, { frameId: doc.frames[0]!.id, component: 'femur' }, pose, 'b'));
    const { cells } = store.doc;
    // The same folder once more, as to bring a frame that was missing.
    await open(...files, at('/study/f2.png'));
    expect(store.doc.frames).toHaveLength(2);
    expect(store.doc.components.femur.model?.name).toBe('femur_mm.stl');
    expect(store.doc.cells).toBe(cells);
    const doc = readDoc(JSON.parse(JSON.stringify(plainDoc(store.doc))), '');
    expect(doc.components.femur.model).toEqual(store.doc.components.femur.model);
  });
});
