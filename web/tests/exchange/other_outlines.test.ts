import { strToU8, zipSync } from 'fflate';
import { describe, expect, it } from 'vitest';
import { readCoco } from '../../src/exchange/coco';
import { readRegions } from '../../src/exchange/imagej';
import { readLabelme } from '../../src/exchange/labelme';
import { maskOfRuns, runsOf } from '../../src/exchange/runs';

/** As pycocotools 2.0 packs it. */
const PACKED = { size: [7, 9], counts: '221030M000000O100000O00001221MM40L10' };
const ROWS = ['001100001', '001011101', '100100110', '101001101', '011011110', '110100010', '101010011'];

/** As roifile writes them: a polygon of parts of pixels in slice 3 with a name, and one of whole pixels. */
const PARTS =
  '496f757400e507000014000a003d001f0003000000000000000000000000000000000000000000000000000000000000000000a80000000000000003000000640000001400120000000200284120000041f4000041e0000041a0000041b000004271000000000000000000000000000000000000000000a4000000050000000000000000000000000000000000000000000000000000000000000000000000000000000000660065006d00750072';
const WHOLE =
  '496f757400e507000014000a003d001f000300000000000000000000000000000000000000000000000000000000000000000028000000000000000000000000000000140012000000020028';

function bytes(hex: string): Uint8Array<ArrayBuffer> {
  return Uint8Array.from(hex.match(/../g)!, (two) => Number.parseInt(two, 16));
}

function rowsOf(mask: Uint8Array, width: number): string[] {
  return Array.from({ length: mask.length / width }, (_, row) => mask.slice(row * width, (row + 1) * width).join(''));
}

describe('run lengths', () => {
  it('are the same packed and plain', () => {
    const runs = runsOf(PACKED)!;
    expect(rowsOf(maskOfRuns(runs), 9)).toEqual(ROWS);
    expect(runsOf({ size: [7, 9], counts: runs.counts })).toEqual(runs);
  });

  it('are none where they do not fill the picture, or are damaged', () => {
    const damaged = [null, [], 'x', {}, { size: [7, 9] }, { size: [7, 9], counts: '22' }, { size: [7, 9], counts: PACKED.counts.slice(0, -1) }];
    const hostile = [{ size: [7, 8], counts: PACKED.counts }, { size: [1e9, 1e9], counts: [1e18] }, { size: [2, 2], counts: [-4, 8] }, { size: [2, 2], counts: 'ooooooooooooooooo' }];
    for (const one of [...damaged, ...hostile]) expect(runsOf(one)).toBeNull();
  });

  it('of annotations wait for their outlines, and polygons do not', () => {
    const annotation = (id: number, segmentation: unknown) => ({ id, image_id: 1, category_id: 2, segmentation });
    const file = {
      images: [{ id: 1, file_name: 'a.png', width: 9, height: 7 }],
      categories: [{ id: 2, name: 'femur' }],
      annotations: [annotation(1, PACKED), annotation(2, [[0, 0, 4, 0, 4, 4]]), annotation(3, { size: [7, 9], counts: [1] })],
    };
    const { items, masks, remarks } = readCoco(JSON.stringify(file));
    expect(items.map(({ label }) => label)).toEqual(['a.png, femur (annotation 2)']);
    expect(masks.map(({ item, runs }) => [item.subject, item.size, runs.width])).toEqual([['femur', { width: 9, height: 7 }, 9]]);
    expect(remarks).toEqual(['annotation 3 (a.png) has run lengths that do not fill its image']);
  });
});

describe('labelme', () => {
  const shape = (label: string, shape_type: string, points: number[][]) => ({ label, shape_type, points, group_id: null, flags: {} });
  const file = (shapes: unknown[]) => JSON.stringify({ version: '5.4.1', flags: {}, shapes, imagePath: '..\\films\\0003.png', imageData: null, imageHeight: 480, imageWidth: 640 });

  it('gives its polygons, of the image that it names', () => {
    const { items, remarks } = readLabelme(file([shape('femur', 'polygon', [[1, 2], [30.5, 2], [30, 40]]), shape('tray', 'rectangle', [[1, 2], [3, 4]])]), '0003.json', { order: 2, images: 9 });
    expect(items).toMatchObject([{ image: '0003.png', order: 2, images: 9, subject: 'femur', size: { width: 640, height: 480 }, label: '0003.png, femur' }]);
    expect(items[0]!.outline.points[1]).toMatchObject({ column: 30.5, row: 2 });
    expect(remarks).toEqual(['"tray" is a rectangle of 2 points: only polygons are read']);
  });

  it('says what is wrong with it', () => {
    expect(() => readLabelme(file([]), 'a.json', { order: 0, images: 1 })).toThrow('there are no shapes in it');
    expect(() => readLabelme(file([shape('femur', 'polygon', [[1, 2], [3], [4, 5]])]), 'a.json', { order: 0, images: 1 })).toThrow('file.shapes[0].points[1] should be a pair of numbers, column and row');
  });
});

describe('regions of ImageJ', () => {
  it('have corners of whole pixels or parts of them, and their slice is their place', () => {
    const { items } = readRegions(bytes(PARTS), 'x.roi');
    expect(items).toMatchObject([{ image: '', order: 2, subject: 'femur', label: 'x.roi, femur' }]);
    expect(items[0]!.outline.points.map(({ column, row }) => [column, row])).toEqual([[10, 20], [30.5, 22], [28, 60.25]]);
    const whole = readRegions(bytes(WHOLE), 'tibia_0007.roi', 4).items[0]!;
    expect(whole).toMatchObject({ order: 4, image: 'tibia_0007.roi', subject: 'tibia', label: 'tibia_0007.roi, tibia_0007' });
    expect(whole.outline.points.map(({ column, row }) => [column, row])).toEqual([[10, 20], [30, 22], [28, 60]]);
  });

  it('come in a zip, in which what is no outline is told', () => {
    const rectangle = bytes(WHOLE);
    rectangle[6] = 1;
    const zip = zipSync({ 'femur-10.roi': bytes(WHOLE), 'femur-9.roi': bytes(PARTS), '0001-0020-0030.roi': bytes(WHOLE), 'r.roi': rectangle, 'notes.txt': strToU8('none') });
    const { items, remarks } = readRegions(zip, 'RoiSet-tibia.zip');
    expect(items.map(({ image, order, subject }) => [image, order, subject])).toEqual([['', 0, 'tibia'], ['', 2, 'femur'], ['femur-10.roi', 2, 'femur']]);
    expect(remarks).toEqual(['r.roi: it is a rectangle: only polygons and what was drawn freely or traced are read']);
  });

  it('that are cut short or hostile are refused in words', () => {
    for (const hex of [PARTS, WHOLE]) {
      const whole = bytes(hex);
      for (let length = 4; length < 76; length++) expect(() => readRegions(whole.slice(0, length), 'x.roi')).toThrow(/cut short|corners|no region/);
    }
    const many = bytes(WHOLE);
    many[16] = many[17] = 255;
    expect(() => readRegions(many, 'x.roi')).toThrow('it is cut short or damaged');
    expect(() => readRegions(strToU8('PK\u0003\u0004nothing'), 'x.zip')).toThrow('it is cut short or damaged');
    const nowhere = bytes(PARTS);
    nowhere.set([0x7f, 0xc0, 0, 0], 64 + 4 * 3);
    expect(() => readRegions(nowhere, 'x.roi')).toThrow('a corner of it is no number');
    const composite = bytes(WHOLE);
    composite[39] = 9;
    expect(() => readRegions(composite, 'x.roi')).toThrow('it is made of several regions: export each');
  });
});
