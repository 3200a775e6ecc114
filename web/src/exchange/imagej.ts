import { unzipSync } from 'fflate';
import { framePoint, type FramePoint } from '../geometry/points';
import { componentNamed, type ProposedItem, type ReadOutlines } from '../document/proposal';
import { ReadError } from '../document/reader';
import { later } from '../texts/later';
import { byName } from './name_order';

/**
 * Regions of ImageJ: one in a file (`.roi`), or several in a zip, as its manager of regions writes them. Numbers begin with their highest byte;
 * corners are columns and rows in pixels, as ours are. An outline is a polygon or was drawn freely or traced.
 */
const MARK = 0x496f7574;
const OUTLINES: readonly number[] = [0, 7, 8];
const NAMES = ['polygon', 'rectangle', 'oval', 'line', 'freehand line', 'polyline', 'region', 'freehand', 'traced', 'angle', 'point'];
/** Of the options: corners are also there as parts of pixels. */
const SUBPIXEL = 128;
const SINCE_SUBPIXEL = 222;
const CORNERS = 64;

/** A region's file is small, bytes, and of a film there are not more. */
const MOST_BYTES = 4e6;
const MOST_REGIONS = 20_000;

interface Region {
  readonly file: string;
  readonly bytes: Uint8Array;
}

/** Items for a proposal, and sentences about regions that are no outlines; `order`: of a file of one among those that come with it. */
export function readRegions(bytes: Uint8Array, file: string, order = 0): ReadOutlines {
  const isZip = bytes[0] === 0x50;
  const regions = isZip ? unpacked(bytes) : [{ file, bytes }];
  const items: ProposedItem[] = [];
  const remarks: string[] = [];
  for (const [at, region] of regions.entries()) {
    try {
      items.push(itemOf(region, order + at, file));
    } catch (error) {
      if (!(error instanceof ReadError)) throw error;
      if (!isZip) throw error;
      remarks.push(`${region.file}: ${error.message}`);
    }
  }
  return { items, remarks };
}

function unpacked(bytes: Uint8Array): readonly Region[] {
  let regions = 0;
  const filter = ({ name, originalSize }: { readonly name: string; readonly originalSize: number }) => /\.roi$/i.test(name) && originalSize <= MOST_BYTES && ++regions <= MOST_REGIONS;
  const files = attempted(() => unzipSync(bytes, { filter }));
  return Object.entries(files).map(([file, bytes]) => ({ file, bytes })).sort((a, b) => byName(a.file, b.file));
}

/** What lies beyond a file's end throws in words of the platform's. */
function attempted<T>(read: () => T): T {
  try {
    return read();
  } catch (error) {
    throw error instanceof ReadError ? error : new ReadError('it is cut short or damaged');
  }
}

function itemOf({ file, bytes }: Region, at: number, source: string): ProposedItem {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const points = attempted(() => cornersOf(view));
  if (!points.every(({ column, row }) => Number.isFinite(column + row))) throw new ReadError('a corner of it is no number');
  const name = attempted(() => nameOf(view)) || file.replace(/\.roi$/i, '');
  const slice = attempted(() => view.getInt32(56));
  // Names that ImageJ gives are slice and place, and no frame's.
  const isNamedByPlace = slice > 0 || /^\d{4,}(-\d{4,}){1,2}$/.test(name);
  return {
    label: name === file ? file : `${file}, ${name}`,
    image: isNamedByPlace ? '' : file,
    order: slice > 0 ? slice - 1 : at,
    images: null,
    frameId: null,
    subject: componentNamed(name) ?? componentNamed(file) ?? componentNamed(source) ?? later.exchange.unnamed,
    size: null,
    outline: { points, closed: true, unknownSides: [] },
    exactOutline: null,
    notes: [],
  };
}

function cornersOf(view: DataView): readonly FramePoint[] {
  if (view.getUint32(0) !== MARK) throw new ReadError('it is no region of ImageJ');
  const [version, kind, count, options] = [view.getInt16(4), view.getUint8(6), view.getUint16(16), view.getInt16(50)];
  if (view.getInt32(36) > 0) throw new ReadError('it is made of several regions: export each');
  if (!OUTLINES.includes(kind)) throw new ReadError(`it is a ${NAMES[kind] ?? 'region'}: only polygons and what was drawn freely or traced are read`);
  if (count < 3) throw new ReadError(`it has ${count} corners`);
  const places = Array.from({ length: count }, (_, index) => index);
  if (options & SUBPIXEL && version >= SINCE_SUBPIXEL) {
    const floats = CORNERS + 4 * count;
    return places.map((index) => framePoint(view.getFloat32(floats + 4 * index), view.getFloat32(floats + 4 * (count + index))));
  }
  const [top, left] = [view.getInt16(8), view.getInt16(10)];
  return places.map((index) => framePoint(left + view.getInt16(CORNERS + 2 * index), top + view.getInt16(CORNERS + 2 * (count + index))));
}

/** As its second header has it; empty where there is none. */
function nameOf(view: DataView): string {
  const header = view.getInt32(60);
  if (header <= 0) return '';
  const [start, length] = [view.getInt32(header + 16), view.getInt32(header + 20)];
  const letters = Array.from({ length: Math.min(Math.max(0, length), 1000) }, (_, index) => view.getUint16(start + 2 * index));
  return String.fromCharCode(...letters);
}
