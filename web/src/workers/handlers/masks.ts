import { strToU8, zipSync, type Zippable } from 'fflate';
import { labelsOfMask, maskOfOutline, outlineOfMask, type FrameImage } from '../../pkg/core/fluoropose_wasm.js';
import initDecode, { encodeMask, FrameFile, type DecodedFrame } from '../../pkg/decode/fluoropose_decode.js';
import decodeAddress from '../../pkg/decode/fluoropose_decode_bg.wasm?url';
import type { MaskLabel, MaskLook, MaskPage, MasksProtocol } from '../protocol/masks';
import { loadCore } from './core_module';
import { imageOf } from './frame_pixels';
import { serve, type Context } from './serve';

/** Masks to outlines and outlines to masks, with both modules: one decodes and encodes, the other follows and fills. */
const ready = Promise.all([loadCore(), initDecode({ module_or_path: decodeAddress })]);

type Buffered = Float64Array<ArrayBuffer>;

/** More grey values than this besides black: no mask, an image. */
const MOST_LABELS = 8;

serve<MasksProtocol>({
  look: async ({ bytes, name }) => {
    await ready;
    return using(new FrameFile(bytes, name), (file) => using(file.frame(0), lookAt));
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
  trace: async ({ inside, width, height, tolerance }) => {
    await ready;
    if (!inside.includes(1)) return null;
    return using(imageOf({ pixels: inside, width, height }), (page) => labelOf(page, 1, tolerance));
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
    return zipSync(files, { level: 0 }) as Uint8Array<ArrayBuffer>;
  },
});

const README = 'One grey PNG of 8 bits for each outline: 255 inside, 0 outside. Folders are components, names those of the frames.\r\n';

async function readPages(file: FrameFile, name: string, tolerance: number, context: Context<{ done: number; total: number }>): Promise<MaskPage[]> {
  const pages: MaskPage[] = [];
  const total = file.count;
  // Of a film one that shows no implant has small values alone.
  const least = total > 1 ? file.gradedFrom() : undefined;
  for (let index = 0; index < total; index++) {
    const where = total === 1 ? name : `${name} #${index + 1}`;
    pages.push(using(file.frame(index), (frame) => (least === undefined ? readPage(frame, where, tolerance) : using(frame.maskFrom(least), (mask) => readPage(mask, where, tolerance)))));
    context.report({ done: index + 1, total });
    await context.breathe();
  }
  return pages;
}

function readPage(frame: DecodedFrame, where: string, tolerance: number): MaskPage {
  const { width, height } = frame;
  const graded = frame.gradedMask();
  if (graded) return using(graded, (mask) => readPage(mask, where, tolerance));
  return using(imageOf(frame), (page) => {
    const values = labelsOfMask(page, MOST_LABELS);
    if (!values) throw new Error(`${where} has more than ${MOST_LABELS} grey values: it is no mask`);
    return { width, height, labels: Array.from(values, (value) => labelOf(page, value, tolerance)) };
  });
}

function labelOf(page: FrameImage, value: number, tolerance: number): MaskLabel {
  return using(outlineOfMask(page, value, tolerance), ({ points, exact, area, specks, holes, differing }) => {
    return { value, points: points as Buffered, exact: exact as Buffered, area, specks, holes, differing };
  });
}

function lookAt(frame: DecodedFrame): MaskLook {
  const { pixels, width, height } = frame;
  const [first] = pixels;
  if (pixels.every((grey: number) => grey === first)) return 0;
  const labels = using(imageOf({ pixels, width, height }), (page) => labelsOfMask(page, MOST_LABELS)?.length);
  if (labels !== undefined) return labels;
  const graded = frame.gradedMask();
  graded?.free();
  return graded ? 'graded' : null;
}

function using<H extends { free(): void }, T>(held: H, work: (held: H) => T): T {
  try {
    return work(held);
  } finally {
    held.free();
  }
}
