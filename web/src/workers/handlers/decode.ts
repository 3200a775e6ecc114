import init, { decode_model, FrameFile, gapsAmong, sniff, type DecodedFrame as RawFrame } from '../../pkg/decode/fluoropose_decode.js';
import wasmAddress from '../../pkg/decode/fluoropose_decode_bg.wasm?url';
import type { DecodedFrame, DecodeProtocol, FileKind, StatedGeometry } from '../protocol/decode';
import { printOf } from './print';
import { serve, type Context } from './serve';

/** Image and model files, decoded away from the page. */
const ready = init({ module_or_path: wasmAddress });

type FrameProgress = DecodeProtocol['frames']['progress'];

serve<DecodeProtocol>({
  sniff: async ({ head, length, name }) => {
    await ready;
    return kindOf(sniff(head, length, name));
  },
  gapsAmong: async ({ names }) => {
    await ready;
    return gapsAmong([...names]) ?? null;
  },
  frames: async ({ blob, name }, context) => {
    await ready;
    const file = await opened(blob, name);
    try {
      await decodeAll(file, context);
      return file.count;
    } finally {
      file.free();
    }
  },
  frame: async ({ key, blob, name, index }) => {
    await ready;
    if (held?.key !== key) {
      held?.file.free();
      held = null;
      held = { key, file: await opened(blob, name) };
    }
    return taken(held.file, index);
  },
  model: async ({ bytes, name }) => {
    await ready;
    const model = decode_model(bytes, name);
    const vertices = model.vertices as Float32Array<ArrayBuffer>;
    const triangles = model.triangles as Uint32Array<ArrayBuffer>;
    const { notes } = model;
    model.free();
    return { vertices, triangles, notes };
  },
});

/** The file that a frame was last taken from: a film in one file is read once. */
let held: { readonly key: string; readonly file: FrameFile } | null = null;

async function opened(blob: Blob, name: string): Promise<FrameFile> {
  return new FrameFile(new Uint8Array(await blob.arrayBuffer()), name);
}

function taken(file: FrameFile, index: number): DecodedFrame {
  const raw = file.frame(index);
  try {
    return copied(raw, { rate: file.framesPerSecond ?? null, place: file.instanceNumber ?? null });
  } finally {
    raw.free();
  }
}

async function decodeAll(file: FrameFile, context: Context<FrameProgress>): Promise<void> {
  const total = file.count;
  for (let index = 0; index < total; index++) {
    const frame = taken(file, index);
    context.report({ index, total, frame, print: printOf(frame.pixels) });
    await context.breathe();
  }
}

function copied(raw: RawFrame, ofFile: OfFile): DecodedFrame {
  const { width, height, windowCentre: centre, windowWidth, notes } = raw;
  const stated = centre !== undefined && windowWidth !== undefined;
  // The pixels that it covers are others then.
  const covered = raw.cover() as DecodedFrame['covered'];
  return {
    width,
    height,
    covered,
    pixels: raw.pixels as DecodedFrame['pixels'],
    window: stated ? { centre, width: windowWidth } : null,
    notes,
    geometry: geometryOf(raw, ofFile),
  };
}

type OfFile = Pick<StatedGeometry, 'rate' | 'place'>;

function geometryOf(raw: RawFrame, ofFile: OfFile): StatedGeometry {
  const { columnSpacingMm, rowSpacingMm, pixelSpacingCalibration } = raw;
  return {
    detectorSpacing: pairOf([columnSpacingMm, rowSpacingMm]),
    pixelSpacing: pairOf(Array.from(raw.pixelSpacingMm)),
    pixelSpacingCalibration: (pixelSpacingCalibration as 'geometry' | 'fiducial' | undefined) ?? null,
    scannedSpacing: pairOf(Array.from(raw.scannedSpacingMm)),
    sourceToDetector: raw.sourceToDetectorMm ?? null,
    sourceToPatient: raw.sourceToPatientMm ?? null,
    sourceToIsocentre: raw.sourceToIsocentreMm ?? null,
    magnification: raw.magnification ?? null,
    ...ofFile,
  };
}

function pairOf([across, along]: readonly (number | undefined)[]): readonly [number, number] | null {
  return across === undefined || along === undefined ? null : [across, along];
}

function kindOf(word: string): FileKind {
  switch (word) {
    case 'png':
    case 'jpeg':
    case 'jpeg2000':
    case 'tiff':
    case 'bmp':
    case 'dicom':
    case 'numpy':
      return 'frames';
    case 'stl':
    case 'obj':
    case 'ply':
      return 'model';
    case 'jts':
      return 'poses';
    case 'calibration':
    case 'mayacam':
      return 'calibration';
    case 'library':
    case 'session':
    case 'outlines':
    case 'coco':
    case 'labelme':
    case 'imagej':
    case 'distortion':
    case 'study':
    case 'video':
    case 'other-model':
      return word;
    default:
      return 'unknown';
  }
}
