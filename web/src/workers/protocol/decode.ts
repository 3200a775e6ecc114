import type { ComponentName } from '../../terms/component';
import type { FramePixels } from './frame_pixels';

export interface ModelMesh {
  /** x, y, z of each vertex, millimetres. */
  readonly vertices: Float32Array<ArrayBuffer>;
  /** Three vertices each. */
  readonly triangles: Uint32Array<ArrayBuffer>;
  /** What was left out of the file, a sentence each. */
  readonly notes?: readonly string[];
}

export interface DecodedFrame extends FramePixels {
  /** As the file suggests, if it does. */
  readonly window: { readonly centre: number; readonly width: number } | null;
  /** What was done to the pixels on the way, a sentence each. */
  readonly notes: readonly string[];
  /** What the file says of sizes, distances and times. */
  readonly geometry: StatedGeometry;
}

/** Lengths in mm as a file states them; null where it does not. Pairs: along a row, then from row to row. */
export interface StatedGeometry {
  readonly detectorSpacing: readonly [number, number] | null;
  readonly pixelSpacing: readonly [number, number] | null;
  readonly pixelSpacingCalibration: 'geometry' | 'fiducial' | null;
  readonly scannedSpacing: readonly [number, number] | null;
  readonly sourceToDetector: number | null;
  readonly sourceToPatient: number | null;
  readonly sourceToIsocentre: number | null;
  readonly magnification: number | null;
  /** Frames a second. */
  readonly rate: number | null;
  /** The file's place among those of its series. */
  readonly place: number | null;
}

/** What a model's surface and shape tell. */
export interface ShapeFacts {
  /** The component that it has the shape of; null where that does not tell. */
  readonly component: ComponentName | null;
  /** What a person should know of it, sentences without their full stops. */
  readonly remarks: readonly string[];
}

export type FileKind = 'frames' | 'model' | 'calibration' | 'poses' | 'library' | 'session' | 'outlines' | 'coco' | 'labelme' | 'imagej' | 'distortion' | 'study' | 'video' | 'other-model' | 'unknown';

export interface DecodeProtocol {
  /** By the file's beginning and its length, bytes. */
  sniff: { input: { head: Uint8Array<ArrayBuffer>; length: number; name: string }; output: FileKind; progress: never };
  /** What is missing among files that are numbered, a sentence without its full stop; names in their order. */
  gapsAmong: { input: { names: readonly string[] }; output: string | null; progress: never };
  /** Frames arrive one by one as progress. */
  frames: {
    input: { blob: Blob; name: string };
    output: number;
    /** `print` tells pictures from each other by their pixels. */
    progress: { readonly index: number; readonly total: number; readonly frame: DecodedFrame; readonly print: number };
  };
  /** One of them. `key` names the file: one that is open already is not read again. */
  frame: { input: { key: string; blob: Blob; name: string; index: number }; output: DecodedFrame; progress: never };
  model: { input: { bytes: Uint8Array<ArrayBuffer>; name: string }; output: ModelMesh; progress: never };
}
