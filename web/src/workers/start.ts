import { Bridge, type WorkerPort } from './bridge';
import type { MasksProtocol } from './protocol/masks';
import type { CalibrateProtocol } from './protocol/calibrate';
import type { FilmProtocol } from './protocol/film';
import type { FollowProtocol } from './protocol/follow';
import type { PoseProtocol } from './protocol/pose';
import type { OverlayProtocol } from './protocol/overlay';
import type { LibraryProtocol } from './protocol/library';
import type { DecodeProtocol } from './protocol/decode';

/** Each worker starts with its first call. */
export function decodeWorker(): Bridge<DecodeProtocol> {
  return new Bridge<DecodeProtocol>(() =>
    port(new Worker(new URL('./handlers/decode.ts', import.meta.url), { type: 'module', name: 'decode' })),
  );
}

export function libraryWorker(): Bridge<LibraryProtocol> {
  return new Bridge<LibraryProtocol>(() =>
    port(new Worker(new URL('./handlers/library.ts', import.meta.url), { type: 'module', name: 'library' })),
  );
}

export function poseWorker(): Bridge<PoseProtocol> {
  return new Bridge<PoseProtocol>(() =>
    port(new Worker(new URL('./handlers/pose.ts', import.meta.url), { type: 'module', name: 'pose' })),
  );
}

export function filmWorker(): Bridge<FilmProtocol> {
  return new Bridge<FilmProtocol>(() =>
    port(new Worker(new URL('./handlers/film.ts', import.meta.url), { type: 'module', name: 'film' })),
  );
}

export function followWorker(): Bridge<FollowProtocol> {
  return new Bridge<FollowProtocol>(() =>
    port(new Worker(new URL('./handlers/follow.ts', import.meta.url), { type: 'module', name: 'follow' })),
  );
}

export function masksWorker(): Bridge<MasksProtocol> {
  return new Bridge<MasksProtocol>(() =>
    port(new Worker(new URL('./handlers/masks.ts', import.meta.url), { type: 'module', name: 'masks' })),
  );
}

export function overlayWorker(): Bridge<OverlayProtocol> {
  return new Bridge<OverlayProtocol>(() =>
    port(new Worker(new URL('./handlers/overlay.ts', import.meta.url), { type: 'module', name: 'overlay' })),
  );
}

export function calibrateWorker(): Bridge<CalibrateProtocol> {
  return new Bridge<CalibrateProtocol>(() =>
    port(new Worker(new URL('./handlers/calibrate.ts', import.meta.url), { type: 'module', name: 'calibrate' })),
  );
}

function port(worker: Worker): WorkerPort {
  return worker as unknown as WorkerPort;
}
