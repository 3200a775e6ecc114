import { describe, expect, it } from 'vitest';
import { Cells } from '../../src/document/cells';
import { addFrames } from '../../src/document/commands';
import { readCoco, writeCoco } from '../../src/exchange/coco';
import { importProposal } from '../../src/document/importing';
import { readOutlines, writeOutlines } from '../../src/exchange/outline_file';
import { assignments, componentNamed, frameNamed, likelyMatch, unevenSubjects, type Proposal, type ProposedItem } from '../../src/document/proposal';
import { Store } from '../../src/document/store';
import { cellKey, cellOf, type Doc, type Outline } from '../../src/document/types';
import { masksOf } from '../../src/exchange/exporter';
import { itemsOf, masksBy, mayBeMask, type ReadMask } from '../../src/exchange/importer';
import type { MaskLook } from '../../src/workers/protocol/masks';
import { framePoint } from '../../src/geometry/points';

const triangle: Outline = { points: [framePoint(10.25, 10), framePoint(50, 1 / 3), framePoint(30, 60)], closed: true, unknownSides: [1] };
const square: Outline = { points: [framePoint(5, 5), framePoint(25, 5), framePoint(25, 25), framePoint(5, 25)], closed: true, unknownSides: [] };
const draft: Outline = { points: [framePoint(1, 2), framePoint(3, 4)], closed: false, unknownSides: [] };

function film(names: readonly string[], cells: Record<string, Outline> = {}): Store {
  const store = new Store();
  store.perform(addFrames(names.map((name, index) => ({ id: `f${index}`, name, source: 's', indexInSource: index, width: 100, height: 80 }))));
  store.amend((doc) => ({
    ...doc,
    cells: Cells.from(Object.entries(cells).map(([key, outline]) => [key, { outline, result: null, resultOf: null }])),
  }));
  return store;
}

const NAMES = ['0001.png', '0002.png', '0003.png'];
const TRACED = { [cellKey('f0', 'femur')]: triangle, [cellKey('f2', 'femur')]: square, [cellKey('f2', 'tibia')]: draft };

function proposal(doc: Doc, items: readonly ProposedItem[], more: Partial<Proposal> = {}): Proposal {
  const subjects = Object.fromEntries(items.map(({ subject }) => [subject, componentNamed(subject)]));
  return { items, subjects, match: likelyMatch(doc, items), exact: false, onFrames: false, asFrames: null, remarks: [], ...more };
}

function item(image: string, order: number, more: Partial<ProposedItem> = {}): ProposedItem {
  const size = { width: 100, height: 80 };
  return { label: image, image, order, images: null, frameId: null, subject: 'femur', size, outline: square, exactOutline: null, notes: [], ...more };
}

const outlineAt = (store: Store, frame: number, component: 'femur' | 'tibia') => cellOf(store.doc, `f${frame}`, component).outline;

describe('our outlines', () => {
  it('come back as they left, drafts and unknown sides too', () => {
    const json = writeOutlines(film(NAMES, TRACED).doc, 'fluoropose 0');
    const store = film(NAMES);
    store.perform(importProposal(store.doc, proposal(store.doc, readOutlines(json))));
    expect(outlineAt(store, 0, 'femur')).toEqual(triangle);
    expect(outlineAt(store, 2, 'femur')).toEqual(square);
    expect(outlineAt(store, 2, 'tibia')).toEqual(draft);
    expect(outlineAt(store, 1, 'femur')).toBeNull();
    store.undo();
    expect(store.doc.cells.isEmpty).toBe(true);
  });

  it.each([
    ['"version":1', '"version":2', /version 2/],
    ['"closed":true', '"closed":1', /frames\[0\]\.outlines\[0\]\.closed should be true or false/],
    ['"unknownSides":[1]', '"unknownSides":[3]', /names side 3 of 3/],
    ['"femur"', '"patella"', /"femur" or "tibia"/],
    ['[10.25,10]', '[10.25]', /pair of numbers/],
    ['fluoropose-outlines', 'another', /holds no outlines/],
  ])('say where they are wrong: %s as %s', (from, to, sentence) => {
    const json = writeOutlines(film(NAMES, TRACED).doc, 'fluoropose 0');
    expect(json).toContain(from);
    expect(() => readOutlines(json.replace(from, to))).toThrow(sentence);
  });

  it('are refused when the file is cut short', () => {
    const json = writeOutlines(film(NAMES, TRACED).doc, 'fluoropose 0');
    expect(() => readOutlines(json.slice(0, -20))).toThrow(/cut short or damaged/);
  });
});

describe('COCO', () => {
  it('closed outlines come back as polygons; drafts do not leave', () => {
    const json = writeCoco(film(NAMES, TRACED).doc, 'fluoropose 0');
    const { annotations } = JSON.parse(json) as { annotations: { bbox: number[]; area: number }[] };
    expect(annotations).toHaveLength(2);
    expect(annotations[1]).toMatchObject({ bbox: [5, 5, 20, 20], area: 400, category_id: 1, iscrowd: 0 });
    const { items, remarks } = readCoco(json);
    expect(remarks).toEqual([]);
    const store = film(NAMES);
    store.perform(importProposal(store.doc, proposal(store.doc, items)));
    expect(outlineAt(store, 0, 'femur')).toEqual({ ...triangle, unknownSides: [] });
    expect(outlineAt(store, 2, 'femur')).toEqual(square);
    expect(outlineAt(store, 2, 'tibia')).toBeNull();
  });

  const polygon = [5, 5, 25, 5, 25, 25, 5, 25];
  const coco = (annotations: unknown[]) =>
    JSON.stringify({
      images: [{ id: 7, file_name: 'export/0002.png', width: 100, height: 80 }],
      categories: [{ id: 3, name: 'Femoral component' }, { id: 4, name: 'tray' }],
      annotations,
    });

  it('takes the largest of several polygons, without its repeated last point, and says so', () => {
    const { items } = readCoco(coco([{ id: 1, image_id: 7, category_id: 3, segmentation: [[0, 0, 1, 0, 1, 1], [...polygon, 5, 5]] }]));
    expect(items[0]?.outline).toEqual(square);
    expect(items[0]?.notes).toEqual(['1 smaller polygon left out']);
  });

  it('names annotations that it cannot use', () => {
    const { items, remarks } = readCoco(
      coco([
        { id: 1, image_id: 7, category_id: 3, segmentation: { counts: [1, 2], size: [80, 100] } },
        { id: 2, image_id: 8, category_id: 3, segmentation: [polygon] },
        { id: 3, image_id: 7, category_id: 9, segmentation: [polygon] },
        { id: 4, image_id: 7, category_id: 3, segmentation: [[1, 2]] },
      ]),
    );
    expect(items).toEqual([]);
    expect(remarks.map((remark) => /^annotation (\d).*(run lengths|does not list|no polygon)/.exec(remark)?.slice(1).join(' '))).toEqual([
      '1 run lengths',
      '2 does not list',
      '3 does not list',
      '4 no polygon',
    ]);
  });

  it('of two annotations for one cell the larger goes there', () => {
    const small = [0, 0, 4, 0, 4, 4, 0, 4];
    const { items } = readCoco(coco([small, polygon].map((segmentation, at) => ({ id: at + 1, image_id: 7, category_id: 3, segmentation: [segmentation] }))));
    const { doc } = film(NAMES);
    const rows = assignments(doc, proposal(doc, items));
    expect(rows.map(({ item, destination }) => [item.label, destination.kind])).toEqual([
      ['export/0002.png, Femoral component (annotation 2)', 'to'],
      ['export/0002.png, Femoral component (annotation 1)', 'nowhere'],
    ]);
  });
});

describe('a proposal', () => {
  const { doc } = film(['knee_08.dcm', 'knee_09.dcm', 'knee_10.dcm']);

  it.each([
    ['knee_09.dcm', 1],
    ['masks/femur/knee_09.png', 1],
    ['KNEE_09.PNG', 1],
    ['mask9.tif', 1],
    ['seg-2026-0010.png', 2],
    ['knee_11.png', -1],
    ['other.png', -1],
  ])('finds the frame of %s', (image, index) => {
    expect(frameNamed(doc, image)).toBe(index);
  });

  it('goes by order only where names say nothing and there are as many', () => {
    expect(likelyMatch(doc, [item('a.png', 0), item('b.png', 1), item('c.png', 2)])).toBe('order');
    expect(likelyMatch(doc, [item('a.png', 0), item('b.png', 1)])).toBe('name');
    expect(likelyMatch(doc, [item('8.png', 0), item('b.png', 1), item('c.png', 2)])).toBe('name');
  });

  it('says why something goes nowhere', () => {
    const items = [item('8.png', 0), item('8.png', 1), item('12.png', 2), item('9.png', 3, { size: { width: 50, height: 40 } }), item('9.png', 4, { subject: 'patella' })];
    const reasons = assignments(doc, proposal(doc, items, { match: 'name' })).map(({ destination }) => (destination.kind === 'to' ? destination.number : destination.reason));
    expect(reasons).toEqual([
      1,
      'frame 1 has an outline of the femur from this import already',
      'no frame is called 12.png',
      'its image has 50 x 40 px, frame 2 has 100 x 80',
      '"patella" is left out',
    ]);
  });

  it('is one unit of undo and tells what it replaces', () => {
    const store = film(NAMES, TRACED);
    const given = proposal(store.doc, [item('1.png', 0), item('2.png', 1)]);
    expect(assignments(store.doc, given).map(({ destination }) => destination.kind === 'to' && destination.replaces)).toEqual([true, false]);
    store.perform(importProposal(store.doc, given));
    expect([outlineAt(store, 0, 'femur'), outlineAt(store, 1, 'femur')]).toEqual([square, square]);
    store.undo();
    expect([outlineAt(store, 0, 'femur'), outlineAt(store, 1, 'femur')]).toEqual([triangle, null]);
  });

  it('takes the exact outline where that is wanted', () => {
    const store = film(NAMES);
    const given = proposal(store.doc, [item('1.png', 0, { exactOutline: triangle })], { exact: true });
    store.perform(importProposal(store.doc, given));
    expect(outlineAt(store, 0, 'femur')).toEqual(triangle);
  });

  it('leads poses from masks on to the frames where that is wanted; of files of outlines who laid them stays', () => {
    const store = film(NAMES);
    const items = [item('1.png', 0, { exactOutline: triangle }), item('2.png', 1)];
    store.perform(importProposal(store.doc, proposal(store.doc, items, { onFrames: true })));
    expect([outlineAt(store, 0, 'femur'), outlineAt(store, 1, 'femur')]).toEqual([{ ...square, laidBy: 'mask' }, square]);
    store.undo();
    store.perform(importProposal(store.doc, proposal(store.doc, items)));
    expect(outlineAt(store, 0, 'femur')).toEqual(square);
  });

  it.each([['Femoral component', 'femur'], ['tibia', 'tibia'], ['tray', 'tibia'], ['tibiofemoral', null], ['1', null]])('%s means %s', (name, component) => {
    expect(componentNamed(name)).toBe(component);
  });
});

describe('masks', () => {
  /** The names of what is taken for masks, of files with so many labels. */
  const masksAmong = (labels: Readonly<Record<string, MaskLook>>) => {
    const files = Object.keys(labels).map((path) => ({ name: path.split('/').at(-1)!, path, blob: new Blob() }));
    return [...masksBy(files, new Map(files.map((file) => [file, labels[file.path]!])))].map(({ path }) => path);
  };

  it('are what has labels; an empty one among frames alone is a blank frame of the film, which keeps its place', () => {
    expect(masksAmong({ 'f/1.png': null, 'f/2.png': 0, 'f/3.png': null })).toEqual([]);
    expect(masksAmong({ '1.png': null, '2.png': 0 })).toEqual([]);
    expect(masksAmong({ 'f/1.png': null, 'f/2.png': 0, 'm/1.png': 1, 'm/2.png': 0 })).toEqual(['m/1.png', 'm/2.png']);
    expect(masksAmong({ '1.png': null, '2.png': 0, '1_mask.png': 1 })).toEqual(['2.png', '1_mask.png']);
    expect(masksAmong({ 'f/1.png': null, 'empty/1.png': 0 })).toEqual(['empty/1.png']);
  });

  it('are probabilities too, in a folder without frames: a frame of the film may be as black and white', () => {
    expect(masksAmong({ 'f/1.png': null, 'm/1.png': 'graded', 'm/2.png': 'graded', 'm/3.png': 0 })).toEqual(['m/1.png', 'm/2.png', 'm/3.png']);
    expect(masksAmong({ 'f/1.png': null, 'f/2.png': 'graded' })).toEqual([]);
  });

  it('that went wrong are masks among masks, and no frames of the film', () => {
    const masks = Object.fromEntries([1, 2, 3, 4, 5].map((number) => [`m/${number}.png`, 1]));
    expect(masksAmong({ 'f/1.png': null, ...masks, 'm/6.png': null })).toContain('m/6.png');
    // Frames with the masks of several components beside them are frames.
    expect(masksAmong({ '1.png': null, '1_femur.png': 1, '1_tibia.png': 1, '1_patella.png': 1 })).not.toContain('1.png');
    expect(masksAmong({ ...masks, 'm/6.png': null })).not.toContain('m/6.png');
  });

  const label = { value: 255, points: Float64Array.of(1, 1, 9, 1, 9, 9), exact: Float64Array.of(1, 1, 9, 1, 9, 9), area: 32, specks: 0, holes: 0, differing: 0 };
  const mask = (path: string, labels = [label]): ReadMask => {
    const file = { kind: 'mask' as const, name: path.split('/').at(-1)!, path, blob: new Blob() };
    return { file, place: '', page: { width: 100, height: 80, labels } };
  };

  it('that are empty or cannot be read keep their places, and are told with their folders', () => {
    const remarks: string[] = [];
    const lost: ReadMask = { ...mask('tibia/b.png'), page: null };
    const read = [mask('femur/a.png', []), mask('femur/b.png'), mask('tibia/a.png'), lost, mask('tibia/c.png')];
    const items = itemsOf(read, remarks);
    expect(items.map(({ label, order, images }) => [label, order, images])).toEqual([['femur/b.png', 1, 2], ['tibia/a.png', 0, 3], ['tibia/c.png', 2, 3]]);
    expect(remarks).toEqual(['femur/a.png is empty: no pixel of it is set']);
  });

  it('of several values keep theirs too: a value that one picture does not have moves no other', () => {
    const [one, two] = [{ ...label, value: 1 }, { ...label, value: 2 }];
    const items = itemsOf([mask('1.png', [one, two]), mask('2.png', [one]), mask('3.png', [one, two])], []);
    expect(items.filter(({ subject }) => subject.endsWith('2')).map(({ order }) => order)).toEqual([0, 2]);
  });

  it('that are mostly specks are told', () => {
    const [item] = itemsOf([mask('femur/a.png', [{ ...label, specks: 40 }])], []);
    expect(item?.notes.at(-1)).toMatch(/is it a mask\?/);
  });

  it('of another number than there are frames are told where they go by order', () => {
    const { doc } = film(['x.dcm', 'y.dcm', 'z.dcm']);
    const items = itemsOf([mask('femur/a.png'), mask('femur/b.png'), mask('tibia/a.png', []), mask('tibia/b.png'), mask('tibia/c.png', [])], []);
    expect(likelyMatch(doc, items)).toBe('order');
    const given = proposal(doc, items);
    expect(unevenSubjects(doc, given)).toEqual([{ subject: 'femur', images: 2 }]);
    expect(unevenSubjects(doc, { ...given, match: 'name' })).toEqual([]);
    expect(unevenSubjects(doc, { ...given, subjects: { femur: null, tibia: 'tibia' } })).toEqual([]);
  });

  it('have the names of their frames, each once', () => {
    const cells = Object.fromEntries(['f0', 'f1', 'f2', 'f3'].map((id) => [cellKey(id, 'femur'), square]));
    const { doc } = film(['a/b.png', 'film.tif #3', 'film.tif #3', 'x.dcm'], { ...cells, [cellKey('f0', 'tibia')]: draft });
    expect(masksOf(doc).map(({ path }) => path)).toEqual(['femur/a_b.png', 'femur/film_0003.png', 'femur/film_0003_2.png', 'femur/x.png']);
  });

  it('are looked for among images that pack well', () => {
    const png = (width: number, height: number, length: number) => {
      const bytes = new Uint8Array(length);
      const view = new DataView(bytes.buffer);
      view.setUint32(0, 0x89504e47);
      view.setUint32(16, width);
      view.setUint32(20, height);
      return bytes;
    };
    const isMask = (bytes: Uint8Array<ArrayBuffer>) => mayBeMask(bytes.slice(0, 33), bytes.length);
    expect(isMask(png(1024, 1024, 5_000))).toBe(true);
    expect(isMask(png(1024, 1024, 300_000))).toBe(false);
    expect(isMask(Uint8Array.from([0x49, 0x49, 42, 0, ...new Array(40).fill(0)]))).toBe(true);
    expect(isMask(Uint8Array.from([1, 2, 3]))).toBe(false);
  });
});
