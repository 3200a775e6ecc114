import { vi } from 'vitest';
import { Assets } from '../../src/document/assets';
import { Store } from '../../src/document/store';
import type { Incoming } from '../../src/exchange/incoming';
import { openFiles } from '../../src/exchange/opener';
import type { Services } from '../../src/jobs/services';

const KINDS: Readonly<Record<string, string>> = { toml: 'study', txt: 'calibration', stl: 'model', step: 'other-model', png: 'frames', jts: 'poses' };
const FRAME = { width: 8, height: 8, pixels: new Uint8Array(64), window: null, geometry: null };

interface Progress {
  readonly onProgress: (progress: unknown) => void;
}

/** A page without workers: files are told by their endings, and a file of frames is one frame of 8 x 8 pixels. `studio`: what else is asked of it. */
export function pageOfFiles(studio: object = {}) {
  const store = new Store();
  const assets = new Assets();
  const models = new Map<string, unknown>();
  /** Files of frames wait here until a test lets them go on. */
  const gates = new Map<string, Promise<void>>();
  let print = 0;
  const call = async (method: string, input: { readonly name: string }, options: Progress) => {
    if (method === 'sniff') return KINDS[input.name.split('.').at(-1) ?? ''] ?? 'unknown';
    if (method === 'model' && input.name.endsWith('.step')) throw new Error(`${input.name}: this is a model in a form that is not read. Export it.`);
    if (method === 'model') return { vertices: new Float64Array([0, 0, 0, 1, 0, 0, 0, 1, 0]), triangles: new Uint32Array([0, 1, 2]) };
    if (method !== 'frames') return null;
    await gates.get(input.name);
    options.onProgress({ index: 0, total: 1, frame: FRAME, print: ++print });
    return null;
  };
  const stands = {
    calibrationFacts: () => ({ principal: null, camera: null }),
    isCalibrationOfOthers: (text: string) => text.startsWith('%YAML'),
    addFrame: () => undefined,
    knowFrame: () => undefined,
    statedGeometry: () => null,
    meshOf: (sha256: string) => models.get(sha256) ?? null,
    addModel: (sha256: string, mesh: unknown) => void models.set(sha256, mesh),
    remarksOn: () => [],
    shapeOf: () => null,
    ...studio,
  };
  const others = { decoder: { call }, shapeOf: async () => ({ component: null, remarks: [] }), checkLibrary: async () => null, ownCalibration: async () => 'JT_INTCALIB\n', doubtsOf: async () => [] };
  const services = { store, assets, studio: stands, ...others } as unknown as Services;
  const open = (...files: Incoming[]) => openFiles(services, files);
  /** Holds the frames of a file back; returns what lets them go on. */
  const held = (name: string) => {
    let go = () => undefined as void;
    gates.set(name, new Promise((resolve) => (go = resolve)));
    return () => go();
  };
  const begun = () => vi.waitUntil(() => store.ui.jobs.length > 0);
  const frames = () => store.doc.frames.map(({ name }) => name);
  const said = () => store.ui.log.map(({ text }) => text).join(' ');
  return { store, assets, services, open, held, begun, frames, said };
}

/** A file at a path of a dropped folder. */
export function at(path: string, content = path): Incoming {
  return { name: path.split('/').at(-1) ?? path, path, blob: new Blob([content]) };
}

/** One that the system does not give, as where a disk is gone, a right is missing, or a file of the cloud is not there. */
export function unreadable(path: string): Incoming {
  const refuse = () => Promise.reject(new DOMException('The requested file could not be read', 'NotReadableError'));
  const blob = { size: 9, type: '', slice: () => ({ arrayBuffer: refuse }), arrayBuffer: refuse };
  return { ...at(path), blob: blob as unknown as Blob };
}
