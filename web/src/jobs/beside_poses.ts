import { filmNumbers, squareOf } from '../document/film';
import type { Doc } from '../document/types';
import { cameraOf } from '../results/keys';
import type { Given } from '../results/spans';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';
import { Aborted, type Bridge } from '../workers/bridge';
import type { CameraInput } from '../workers/protocol/camera';
import type { ModelMesh } from '../workers/protocol/decode';
import type { ReadProfiles } from '../workers/protocol/film';
import type { FollowProtocol } from '../workers/protocol/follow';
import type { FramePixels } from '../workers/protocol/frame_pixels';
import type { Beside } from './film_beside';
import { asJob, type Services } from './services';

/** A component whose film is to be read, and its worker. */
interface Subject {
  readonly component: ComponentName;
  readonly worker: Pick<Bridge<FollowProtocol>, 'call'>;
  readonly span: { readonly given: readonly Given[] };
}

/** Poses that are looked at, and frames to each side of them, as the core has it. */
const POSES = 3;
const BESIDE = 6;

/** Reads the film around the first poses of each component, in all workers at once; gives nothing where it was called off. */
export async function readBeside(services: Services, subjects: readonly Subject[], side: number, abort: AbortController): Promise<ReadonlyMap<ComponentName, Beside>> {
  const { store } = services;
  const last = store.doc.frames.length - 1;
  const around = ({ frame }: Given) => Math.min(frame + BESIDE, last) - Math.max(frame - BESIDE, 0) + 1;
  const total = subjects.flatMap(({ span }) => span.given.slice(0, POSES)).reduce((sum, given) => sum + around(given), 0);
  const job = { title: texts.follow.reading, unit: texts.follow.unit, total, cancel: () => abort.abort() };
  const read = await asJob(store, job, (report) => {
    const looked = counting(report, total);
    return Promise.all(subjects.map(async (subject) => [subject.component, await besideOf(services, subject, side, abort.signal, looked)] as const));
  });
  return new Map(abort.signal.aborted ? [] : read);
}

async function besideOf(services: Services, subject: Subject, side: number, signal: AbortSignal, looked: () => void): Promise<Beside> {
  const { component, worker, span } = subject;
  const { doc } = services.store;
  const { model, ...input } = subjectOf(services, component);
  const given = span.given.slice(0, POSES);
  const first = await worker.call('readFilm', { ...input, component, frames: doc.frames.length, side, given, justThere: false });
  return { model, anchors: anchorsOf(doc, given), read: await profilesFrom(services, subject, first, signal, looked) };
}

/** Reads the film at the first poses of each component, in squares with sides of so many pixels. */
export async function readFirst(services: Services, subjects: readonly Subject[], side: number, signal: AbortSignal): Promise<readonly ReadProfiles[]> {
  const { doc } = services.store;
  const each = subjects.map(async (subject) => {
    const { component, worker, span } = subject;
    const { model: _, ...input } = subjectOf(services, component);
    const given = span.given.slice(0, POSES);
    const first = await worker.call('readFilm', { ...input, component, frames: doc.frames.length, side, given, justThere: true });
    return profilesFrom(services, subject, first, signal, () => undefined);
  });
  return (await Promise.all(each)).flat();
}

/** Reads the film in frames in which a followed component is good, as its worker chooses them; null where these are too few. */
export async function readAsked(services: Services, subject: Subject, otherMiddles: Float64Array<ArrayBuffer>, signal: AbortSignal): Promise<Beside | null> {
  const { component, worker, span } = subject;
  const { doc } = services.store;
  const { model, ...input } = subjectOf(services, component);
  const first = await worker.call('askFilm', { ...input, component, frames: doc.frames.length, side: squareOf(filmNumbers(doc, component)), otherMiddles });
  if (first === null) return null;
  const read = await profilesFrom(services, subject, first, signal, () => undefined);
  return { model, anchors: anchorsOf(doc, span.given.slice(0, POSES)), read };
}

function anchorsOf(doc: Doc, given: readonly Given[]): Beside['anchors'] {
  return given.map(({ frame, pose }) => ({ frameId: doc.frames[frame]!.id, pose }));
}

/** Profiles in all frames that the worker asks for. */
async function profilesFrom(services: Services, { component, worker }: Subject, first: number | null, signal: AbortSignal, looked: () => void): Promise<readonly ReadProfiles[]> {
  const read: ReadProfiles[] = [];
  for (let next = first; next !== null && !signal.aborted; ) {
    const frame = next;
    const { frameId: _, ...input } = await frameAt(services, frame);
    const seen = await worker.call('lookFilm', input, { signal, transfer: [input.pixels.buffer] }).catch(unlessAborted);
    if (!seen) break;
    if (seen.profiles.length > 0) read.push({ component, frame, profiles: seen.profiles });
    next = seen.next;
    looked();
  }
  return read;
}

/** The component's model and the film's camera, as a worker takes them. */
export function subjectOf({ store, studio }: Services, component: ComponentName): { readonly model: string; readonly mesh: ModelMesh; readonly camera: CameraInput } {
  const { doc } = store;
  const model = doc.components[component].model?.sha256 ?? '';
  const mesh = studio.meshOf(model);
  const camera = cameraOf(doc, doc.frames[0] ?? null);
  if (!mesh || !camera) throw new Error(texts.hand.said.noModel(texts.component[component]));
  return { model, mesh, camera };
}

export async function frameAt({ store, studio }: Services, at: number): Promise<FramePixels & { readonly frameId: string }> {
  const frame = store.doc.frames[at];
  const pixels = frame && (await studio.framePixels(frame.id));
  if (!frame || !pixels) throw new Error(texts.follow.gone(at + 1));
  return { frameId: frame.id, ...pixels };
}

export function counting(report: (done: number, total: number) => void, total: number): () => void {
  let done = 0;
  return () => report(Math.min(++done, total), total);
}

/** Who calls off waits for nothing more. */
export function aborted(signal: AbortSignal): Promise<void> {
  return signal.aborted ? Promise.resolve() : new Promise((go) => signal.addEventListener('abort', () => go(), { once: true }));
}

/** Who stops keeps what there is. */
export function unlessAborted(error: unknown): null {
  if (error instanceof Aborted) return null;
  throw error;
}
