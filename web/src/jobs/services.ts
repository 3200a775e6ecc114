import { Assets } from '../document/assets';
import type { Job, Store } from '../document/store';
import { work } from '../workers/activity';
import type { Bridge } from '../workers/bridge';
import type { CameraInput } from '../workers/protocol/camera';
import type { DecodeProtocol, ModelMesh, ShapeFacts, StatedGeometry } from '../workers/protocol/decode';
import type { Studio } from '../films/studio';

/** What the jobs of the page share. */
export interface Services {
  readonly store: Store;
  readonly studio: Studio;
  readonly assets: Assets;
  readonly decoder: Bridge<DecodeProtocol>;
  readonly shapeOf: (mesh: ModelMesh) => Promise<ShapeFacts>;
  /** Throws the core's sentence for a library that is damaged. */
  readonly checkLibrary: (library: Uint8Array<ArrayBuffer>) => Promise<null>;
  /** A calibration in a form of others in one that is read here. Throws the core's sentence about the line or value at fault. */
  readonly ownCalibration: (text: string) => Promise<string>;
  /** What is unusual of a camera, sentences without their full stops. */
  readonly doubtsOf: (camera: CameraInput & { readonly stated: StatedGeometry | null }) => Promise<readonly string[]>;
}

let lastJob = 0;

/** How far a job is; by another title what it is about now. */
export type Report = (done: number, total: number, now?: Partial<Pick<Job, 'title' | 'unit'>>) => void;

/** Shows a job in the page while `task` runs. */
export async function asJob<T>(
  store: Store,
  job: Pick<Job, 'title' | 'unit' | 'total' | 'cancel' | 'place' | 'at'>,
  task: (report: Report, id: number) => Promise<T>,
): Promise<T> {
  const id = ++lastJob;
  const over = work.begin();
  const startedAt = performance.now();
  let isOver = false;
  // What comes late, of a call that was called off, makes no job anew.
  const report: Report = (done, total, now) => void (isOver || store.setJob({ ...job, ...now, id, startedAt, done, total }));
  report(0, job.total);
  try {
    return await task(report, id);
  } finally {
    isOver = true;
    over();
    store.endJob(id);
  }
}

/** The sentence of whatever was thrown. */
export function sentenceOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
