import { Bridge, type WorkerPort } from '../worker/bridge';
import type { MasksProtocol } from './exchange/protocol';
import type { CalibrateProtocol } from './calibrate_protocol';
import type { DecodeProtocol, LibraryProtocol, PoseProtocol } from './protocol';

/** Each worker starts with its first call. */
export function decodeWorker(): Bridge<DecodeProtocol> {
  return new Bridge<DecodeProtocol>(() =>
    port(new Worker(new URL('../worker/decode.ts', import.meta.url), { type: 'module', name: 'decode' })),
  );
}

export function libraryWorker(): Bridge<LibraryProtocol> {
  return new Bridge<LibraryProtocol>(() =>
    port(new Worker(new URL('../worker/library.ts', import.meta.url), { type: 'module', name: 'library' })),
  );
}

export function poseWorker(): Bridge<PoseProtocol> {
  return new Bridge<PoseProtocol>(() =>
    port(new Worker(new URL('../worker/pose.ts', import.meta.url), { type: 'module', name: 'pose' })),
  );
}

export function masksWorker(): Bridge<MasksProtocol> {
  return new Bridge<MasksProtocol>(() =>
    port(new Worker(new URL('../worker/masks.ts', import.meta.url), { type: 'module', name: 'masks' })),
  );
}

export function calibrateWorker(): Bridge<CalibrateProtocol> {
  return new Bridge<CalibrateProtocol>(() =>
    port(new Worker(new URL('../worker/calibrate.ts', import.meta.url), { type: 'module', name: 'calibrate' })),
  );
}

function port(worker: Worker): WorkerPort {
  return worker as unknown as WorkerPort;
}
