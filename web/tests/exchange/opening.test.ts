import { describe, expect, it } from 'vitest';
import { rename } from '../../src/document/commands';
import { withSoFar } from '../../src/document/followed';
import { plainDoc, readDoc } from '../../src/document/session/session';
import { startEmpty } from '../../src/document/start_anew';
import { EMPTY_DOC } from '../../src/document/types';
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

describe('a model in another form', () => {
  it('is to be exported, but where what was exported lies beside it', async () => {
    const { said, open } = pageOfFiles();
    await open(at('/f1.png'), at('/femur.step'));
    expect(said()).toMatch(/^Opened the frame f1\.png\. femur\.step: this is a model in a form that is not read\. Export it\.$/);
    const another = pageOfFiles();
    await another.open(at('/f1.png'), at('/femur.stl'), at('/femur.step'));
    expect(another.said()).toMatch(/left out: femur\.step\.$/);
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

describe('files of frames that are alike to the last bit', () => {
  it('keep their own names', async () => {
    const { frames, open } = pageOfFiles();
    await open(at('/f1.png', 'same'), at('/f2.png', 'same'), at('/f3.png', 'other'));
    expect(frames()).toEqual(['f1.png', 'f2.png', 'f3.png']);
  });

  it('are said to be of the work already where nothing comes of them, and not to be opened', async () => {
    const { store, frames, said, open } = pageOfFiles();
    await open(at('/f1.png', 'same'), at('/f2.png', 'other'));
    expect(said()).toBe('Opened 2 frames.');
    await open(at('/again.png', 'same'));
    expect(frames()).toEqual(['f1.png', 'f2.png']);
    expect(said()).toBe('Opened 2 frames. One frame is of this work already, by its content.');
    expect(store.ui.notice?.kind).toBe('info');
    await open(at('/f1.png', 'same'), at('/f2.png', 'other'), at('/f3.png', 'new'));
    expect(said()).toMatch(/Opened the frame f3\.png\. 2 frames are of this work already, by their content\.$/);
  });
});

describe('frames that are still on their way', () => {
  it('do not come into other work that was begun meanwhile, and that is said', async () => {
    const { store, open, held, begun, frames, said } = pageOfFiles();
    const go = held('a2.png');
    const opening = open(at('/a1.png'), at('/a2.png'), at('/femur.jts'));
    await begun();
    startEmpty(store);
    go();
    expect(await opening).toBe(false);
    expect(frames()).toEqual([]);
    expect(store.doc).toBe(EMPTY_DOC);
    expect(said()).toMatch(/^a1\.png and a2\.png: other work came on view .* femur\.jts: other work came/);
  });

  it('do not come into earlier work that was opened meanwhile, nor does what waits behind them', async () => {
    const { store, open, held, begun, said } = pageOfFiles();
    const go = held('a2.png');
    const openings = [open(at('/a1.png'), at('/a2.png')), open(at('/femur.stl'))];
    await begun();
    const kept = { ...EMPTY_DOC, name: 'kept', work: 'kept', frames: [] };
    store.perform({ label: 'open', apply: () => kept });
    go();
    expect(await Promise.all(openings)).toEqual([false, false]);
    expect(store.doc).toBe(kept);
    expect(said()).toMatch(/a2\.png: other work came on view .* femur\.stl: other work came on view/);
    // What comes now is for what is on view now.
    await open(at('/femur.stl'));
    expect(store.doc.components.femur.model?.name).toBe('femur.stl');
  });

  it('come into their work, which got its name and identity meanwhile', async () => {
    const { store, open, held, begun, frames } = pageOfFiles();
    const go = held('a1.png');
    const opening = open(at('/a1.png'), at('/femur.stl'));
    await begun();
    store.perform(rename('knee'));
    store.amend((doc) => ({ ...doc, work: 'w' }));
    go();
    expect(await opening).toBe(true);
    expect(frames()).toEqual(['a1.png']);
    expect(store.doc).toMatchObject({ name: 'knee', work: 'w' });
  });

  it('are not mixed with those of another whole study, which is opened when they are there', async () => {
    const { store, open, held, begun, frames, said } = pageOfFiles();
    const go = held('a2.png');
    const study = (name: string) => [at(`/camera_${name}.txt`), at(`/femur_${name}.stl`), at(`/${name}1.png`), at(`/${name}2.png`)];
    const openings = [open(...study('a')), open(...study('b'))];
    expect(said()).toMatch(/^camera_b\.txt.*: opened as soon as what came before is\.$/);
    await begun();
    go();
    await Promise.all(openings);
    expect(frames()).toEqual(['b1.png', 'b2.png']);
    expect(store.doc.calibration?.name).toBe('camera_b.txt');
    expect(said()).toContain('It is a study of its own');
    store.ui.notice?.offer?.take();
    expect(frames()).toEqual(['a1.png', 'a2.png']);
    expect(store.doc.calibration?.name).toBe('camera_a.txt');
  });
});

it('what comes to nothing begins no work', async () => {
  const { store, open } = pageOfFiles();
  await open(at('/notes.docx'));
  expect(store.doc).toBe(EMPTY_DOC);
});
