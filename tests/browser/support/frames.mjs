/** Small frames of every kind the page opens, with a pattern whose grey values are known. */
import { encode } from 'fast-png';
import { file } from './files.mjs';

/** Width and height of every small frame. */
export const SIZE = { width: 24, height: 16 };
const PIXELS = SIZE.width * SIZE.height;

/** Grey value of a pixel, 0 to 255: no two neighbours alike. @param {number} column @param {number} row */
export function greyAt(column, row) {
  return (7 * column + 13 * row + 5) % 256;
}

/** @param {(grey: number) => number} change @returns {number[]} */
function pattern(change = (grey) => grey) {
  return Array.from({ length: PIXELS }, (_, at) => change(greyAt(at % SIZE.width, Math.floor(at / SIZE.width))));
}

/** @param {number} depth 8 or 16 @param {(grey: number) => number} [change] */
export function png(depth, change) {
  const data = depth === 8 ? Uint8Array.from(pattern(change)) : Uint16Array.from(pattern(change));
  return file(`grey${depth}.png`, encode({ ...SIZE, data, depth, channels: 1 }));
}

/**
 * A baseline JPEG by the browser's own encoder. Whole blocks of one grey: a frame that JPEG keeps.
 *
 * @param {import('playwright-core').Page} page
 * @param {number} grey
 */
export async function jpeg(page, grey) {
  const address = await page.evaluate(
    ({ width, height, grey }) => {
      const canvas = document.createElement('canvas');
      Object.assign(canvas, { width, height });
      const context = canvas.getContext('2d');
      context.fillStyle = `rgb(${grey}, ${grey}, ${grey})`;
      context.fillRect(0, 0, width, height);
      return canvas.toDataURL('image/jpeg', 1);
    },
    { ...SIZE, grey },
  );
  return file('grey.jpg', Buffer.from(address.split(',')[1], 'base64'));
}

/** Little-endian bytes of 16-bit values. @param {number[]} values */
function words(values) {
  const bytes = Buffer.alloc(2 * values.length);
  values.forEach((value, index) => bytes.writeUInt16LE(value, 2 * index));
  return bytes;
}

/** An uncompressed TIFF of 16-bit pages, after TIFF 6.0. @param {((grey: number) => number)[]} pages */
export function tiff(pages) {
  const head = Buffer.from([0x49, 0x49, 42, 0, 8, 0, 0, 0]);
  const parts = [head];
  let at = head.length;
  pages.forEach((change, index) => {
    const pixels = words(pattern(change));
    const directory = tiffDirectory(at, pixels.length, index === pages.length - 1);
    parts.push(directory, pixels);
    at += directory.length + pixels.length;
  });
  return file('run.tif', Buffer.concat(parts));
}

/** A page's directory, its pixels right after it. @param {number} at @param {number} length @param {boolean} last */
function tiffDirectory(at, length, last) {
  const [short, long] = [3, 4];
  const fields = [
    [256, short, SIZE.width],
    [257, short, SIZE.height],
    [258, short, 16],
    [259, short, 1],
    [262, short, 1],
    [273, long, 0],
    [277, short, 1],
    [278, short, SIZE.height],
    [279, long, length],
  ];
  const size = 2 + 12 * fields.length + 4;
  const directory = Buffer.alloc(size);
  directory.writeUInt16LE(fields.length, 0);
  fields.forEach(([tag, type, value], index) => {
    const entry = 2 + 12 * index;
    directory.writeUInt16LE(tag, entry);
    directory.writeUInt16LE(type, entry + 2);
    directory.writeUInt32LE(1, entry + 4);
    directory.writeUInt32LE(tag === 273 ? at + size : value, entry + 8);
  });
  directory.writeUInt32LE(last ? 0 : at + size + length, size - 4);
  return directory;
}

/**
 * An uncompressed DICOM file of 12 stored bits, explicit little endian, after PS3.5 and PS3.10.
 *
 * @param {((grey: number) => number)[]} frames
 * @param {{ name?: string, number?: number }} [of] `number`: its place in its series
 */
export function dicom(frames, { name = 'run.dcm', number } = {}) {
  const image = [
    ...(number === undefined ? [] : [element(0x0020, 0x0013, 'IS', `${number}`.padEnd(2))]),
    element(0x0028, 0x0002, 'US', words([1])),
    element(0x0028, 0x0004, 'CS', 'MONOCHROME2 '),
    element(0x0028, 0x0008, 'IS', `${frames.length}`.padEnd(2)),
    element(0x0028, 0x0010, 'US', words([SIZE.height])),
    element(0x0028, 0x0011, 'US', words([SIZE.width])),
    element(0x0028, 0x0100, 'US', words([16])),
    element(0x0028, 0x0101, 'US', words([12])),
    element(0x0028, 0x0102, 'US', words([11])),
    element(0x0028, 0x0103, 'US', words([0])),
    element(0x0028, 0x1050, 'DS', '1000'),
    element(0x0028, 0x1051, 'DS', '600 '),
    element(0x7fe0, 0x0010, 'OW', words(frames.flatMap((change) => pattern(change)))),
  ];
  return file(name, withMeta('1.2.840.10008.1.2.1\0', image));
}

/**
 * An uncompressed DICOM film of 8 bits with a round shutter.
 *
 * @param {readonly Uint8Array[]} frames
 * @param {{ width: number, height: number }} size
 * @param {{ column: number, row: number, radius: number }} open pixels as DICOM counts them, from 1
 */
export function shutteredFilm(frames, { width, height }, { column, row, radius }) {
  const text = (/** @type {string} */ value) => value.padEnd(value.length + (value.length % 2));
  const image = [
    element(0x0018, 0x1600, 'CS', text('CIRCULAR')),
    element(0x0018, 0x1610, 'IS', text(`${row}\\${column}`)),
    element(0x0018, 0x1612, 'IS', text(`${radius}`)),
    element(0x0028, 0x0002, 'US', words([1])),
    element(0x0028, 0x0004, 'CS', 'MONOCHROME2 '),
    element(0x0028, 0x0008, 'IS', text(`${frames.length}`)),
    ...[height, width].map((side, index) => element(0x0028, 0x0010 + index, 'US', words([side]))),
    ...[8, 8, 7, 0].map((value, index) => element(0x0028, 0x0100 + index, 'US', words([value]))),
    element(0x7fe0, 0x0010, 'OW', Buffer.concat(frames)),
  ];
  return file('shuttered.dcm', withMeta('1.2.840.10008.1.2.1\0', image));
}

/** A DICOM file after PS3.10. @param {string} syntax of even length @param {readonly Buffer[]} elements */
function withMeta(syntax, elements) {
  const meta = Buffer.concat([element(0x0002, 0x0001, 'OB', Buffer.from([0, 1])), element(0x0002, 0x0010, 'UI', syntax)]);
  const length = Buffer.alloc(4);
  length.writeUInt32LE(meta.length);
  return Buffer.concat([Buffer.alloc(128), Buffer.from('DICM'), element(0x0002, 0x0000, 'UL', length), meta, ...elements]);
}

/** @param {number} group @param {number} number @param {string} representation @param {Buffer | string} value of even length */
function element(group, number, representation, value) {
  const bytes = Buffer.from(value);
  const long = representation === 'OB' || representation === 'OW';
  const head = Buffer.alloc(long ? 12 : 8);
  head.writeUInt16LE(group, 0);
  head.writeUInt16LE(number, 2);
  head.write(representation, 4, 'latin1');
  if (long) head.writeUInt32LE(bytes.length, 8);
  else head.writeUInt16LE(bytes.length, 6);
  return Buffer.concat([head, bytes]);
}

// --- Compressed pixels and further attributes --------------------------------------------------------------------------

/**
 * A JPEG 2000 codestream of 12 x 9 pixels of 12 bits, lossless, by OpenJPEG: nothing in Node writes one. It is the one
 * that the decoder's own tests read, and so is its pattern.
 */
const CODESTREAM = [
  'ff4fff51002900000000000c0000000900000000000000000000000c00000009000000000000000000010b0101ff52000c00',
  '000001000004040001ff5c00044060ff90000a0000000000770001ff93dfe19812322a1595506c15f95fff16657ad59f51aa',
  '12133b6690860f4b4b8d0de2a3463b432e58bbeac477c0fd426a848fe3d9db3377b4b0ce04733a47c604a198d771c32cef65',
  'cb8829008a535ab4aab83553c6a2cec30f58cba2eaf2ebc73945add685a11247e7dfffd9',
].join('');

export const JPEG_2000 = {
  file: { syntax: '1.2.840.10008.1.2.4.90', width: 12, height: 9, codestream: Buffer.from(CODESTREAM, 'hex'), stated: {} },
  /** @param {number} column @param {number} row */
  greyAt(column, row) {
    const at = 12 * row + column;
    return 16 * ((7 * column + 31 * row + ((at * at) % 5)) % 256);
  },
};

/**
 * A DICOM file of one frame in a fragment. `stated` holds further values (DS) by their tags, such as `0018,1110`.
 *
 * @param {{ syntax: string, width: number, height: number, codestream: Buffer, stated: Record<string, string> }} image
 */
export function dicomOf({ syntax, width, height, codestream, stated }) {
  const further = Object.entries(stated).map(([tag, value]) => ({ tag, content: Buffer.from(value.length % 2 ? `${value} ` : value), kind: 'DS' }));
  const image = [
    { tag: '0028,0002', kind: 'US', content: words([1]) },
    { tag: '0028,0004', kind: 'CS', content: Buffer.from('MONOCHROME2 ') },
    { tag: '0028,0010', kind: 'US', content: words([height]) },
    { tag: '0028,0011', kind: 'US', content: words([width]) },
    { tag: '0028,0100', kind: 'US', content: words([16]) },
    { tag: '0028,0101', kind: 'US', content: words([12]) },
    { tag: '0028,0102', kind: 'US', content: words([11]) },
    { tag: '0028,0103', kind: 'US', content: words([0]) },
    ...further,
  ];
  image.sort((a, b) => a.tag.localeCompare(b.tag));
  const elements = image.map(({ tag, kind, content }) => element(...numbersOf(tag), kind, content));
  return file('compressed.dcm', withMeta(syntax.length % 2 ? `${syntax}\0` : syntax, [...elements, fragments(codestream)]));
}

/** @param {string} tag @returns {[number, number]} */
function numbersOf(tag) {
  const [group, number] = tag.split(',').map((half) => Number.parseInt(half, 16));
  return [group ?? 0, number ?? 0];
}

/** Encapsulated pixel data of one fragment, without an offset table. @param {Buffer} content */
function fragments(content) {
  const padded = content.length % 2 ? Buffer.concat([content, Buffer.alloc(1)]) : content;
  const head = Buffer.from([0xe0, 0x7f, 0x10, 0, 0x4f, 0x42, 0, 0, 0xff, 0xff, 0xff, 0xff]);
  const item = (/** @type {number} */ length) => {
    const bytes = Buffer.from([0xfe, 0xff, 0, 0xe0, 0, 0, 0, 0]);
    bytes.writeUInt32LE(length, 4);
    return bytes;
  };
  const end = Buffer.from([0xfe, 0xff, 0xdd, 0xe0, 0, 0, 0, 0]);
  return Buffer.concat([head, item(0), item(padded.length), padded, end]);
}
