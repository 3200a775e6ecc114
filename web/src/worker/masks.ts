import { strToU8, zipSync, type Zippable } from 'fflate';
import { maskOfOutline, outlineOfMask } from '../pkg/core/fluoropose_wasm.js';
import initDecode, { encodeMask, FrameFile } from '../pkg/decode/fluoropose_decode.js';
import decodeAddress from '../pkg/decode/fluoropose_decode_bg.wasm?url';
import type { MaskLabel, MaskPage, MasksProtocol } from '../engine/exchange/protocol';
import { loadCore } from './core_module';
import { serve, Transferred, type Context } from './serve';

/** Masks to outlines and outlines to masks, with both modules: one decodes and encodes, the other follows and fills. */
const ready = Promise.all([loadCore(), initDecode({ module_or_path: decodeAddress })]);

type Buffered = Float64Array<ArrayBuffer>;

/** More grey values than this besides black: no mask, an image. */
const MOST_LABELS = 8;

serve<MasksProtocol>({
  look: async ({ bytes, name }) => {
    await ready;
    return withFile(bytes, name, (file) => labelsOf(pageOf(file, 0).pixels)?.length ?? null);
  },
  read: async ({ bytes, name, tolerance }, context) => {
    await ready;
    const file = new FrameFile(bytes, name);
    try {
      return await readPages(file, name, tolerance, context);
    } finally {
      file.free();
    }
  },
  write: async ({ masks }, context) => {
    await ready;
    const files: Zippable = {};
    for (const [index, { path, width, height, points }] of masks.entries()) {
      files[path] = encodeMask(maskOfOutline(points, width, height), width, height);
      context.report({ done: index + 1, total: masks.length });
      await context.breathe();
    }
    files['README.txt'] = strToU8(README);
    // PNG is packed already.
    const zip = zipSync(files, { level: 0 }) as Uint8Array<ArrayBuffer>;
    return new Transferred(zip, [zip.buffer]);
  },
});

const README = 'One grey PNG of 8 bits for each outline: 255 inside, 0 outside. Folders are components, names those of the frames.\r\n';

async function readPages(file: FrameFile, name: string, tolerance: number, context: Context<{ done: number; total: number }>): Promise<MaskPage[]> {
  const pages: MaskPage[] = [];
  const total = file.count;
  for (let index = 0; index < total; index++) {
    const { pixels, width, height } = pageOf(file, index);
    const values = labelsOf(pixels);
    const where = total === 1 ? name : `${name} #${index + 1}`;
    if (!values) throw new Error(`${where} has more than ${MOST_LABELS} grey values: it is no mask`);
    const labels = values.map((value) => labelOf(pixels, value, width, height, tolerance));
    pages.push({ width, height, labels });
    context.report({ done: index + 1, total });
    await context.breathe();
  }
  return pages;
}

function labelOf(pixels: Uint16Array, value: number, width: number, height: number, tolerance: number): MaskLabel {
  const traced = outlineOfMask(pixels, value, width, height, tolerance);
  try {
    const { area, specks, holes } = traced;
    const [points, exact] = [traced.points as Buffered, traced.exact as Buffered];
    return { value, points, exact, area, specks, holes, differing: difference(exact, points, width, height) };
  } finally {
    traced.free();
  }
}

function difference(a: Float64Array, b: Float64Array, width: number, height: number): number {
  const [one, other] = [maskOfOutline(a, width, height), maskOfOutline(b, width, height)];
  let count = 0;
  for (let at = 0; at < one.length; at++) if (one[at] !== other[at]) count++;
  return count;
}

/** Grey values besides 0, rising; null where there are too many for a mask, or nothing is 0. */
function labelsOf(pixels: Uint16Array): number[] | null {
  const seen = new Set<number>();
  for (const value of pixels) {
    if (seen.has(value)) continue;
    seen.add(value);
    if (seen.size > MOST_LABELS + 1) return null;
  }
  if (!seen.delete(0)) return null;
  return [...seen].sort((a, b) => a - b);
}

function pageOf(file: FrameFile, index: number): { pixels: Uint16Array; width: number; height: number } {
  const frame = file.frame(index);
  try {
    return { pixels: Uint16Array.from(frame.pixels as Uint8Array | Uint16Array), width: frame.width, height: frame.height };
  } finally {
    frame.free();
  }
}

function withFile<T>(bytes: Uint8Array, name: string, work: (file: FrameFile) => T): T {
  const file = new FrameFile(bytes, name);
  try {
    return work(file);
  } finally {
    file.free();
  }
}
