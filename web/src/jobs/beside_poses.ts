import { filmNumbers, squareOf } from '../document/film';
import type { FrameEntry } from '../document/types';
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
  /** Of the film that its numbers of frames count in. */
  readonly frames: readonly FrameEntry[];
  readonly worker: Pick<Bridge<FollowProtocol>, 'call'>;
  readonly span: { readonly given: readonly Given[] };
}

/** Poses that are looked at, and frames to each side of them, as the core has it. */
const POSES = 3;
const BESIDE = 6;

/** Reads the film around the first poses of each component, in all workers at once; gives nothing where it was called off. */
export async function readBeside(services: Services, subjects: readonly Subject[], side: number, abort: AbortController): Promise<ReadonlyMap<ComponentName, Beside>> {
  const { store } = services;
  const around = ({ frame }: Given, last: number) => Math.min(frame + BESIDE, last) - Math.max(frame - BESIDE, 0) + 1;
  const all = subjects.flatMap(({ span, frames }) => span.given.slice(0, POSES).map((given) => around(given, frames.length - 1)));
  const total = all.reduce((sum, each) => sum + each, 0);
  const job = { title: texts.follow.reading, unit: texts.follow.unit, total, cancel: () => abort.abort() };
  const read = await asJob(store, job, (report) => {
    const looked = counting(report, total);
    return Promise.all(subjects.map(async (subject) => [subject.component, await besideOf(services, subject, side, abort.signal, looked)] as const));
  });
  return new Map(abort.signal.aborted ? [] : read);
}

async function besideOf(services: Services, subject: Subject, side: number, signal: AbortSignal, looked: () => void): Promise<Beside> {
  const { component, worker, span, frames } = subject;
  const { model, ...input } = subjectOf(services, component);
  const given = span.given.slice(0, POSES);
  const first = await worker.call('readFilm', { ...input, component, frames: frames.length, side, given, justThere: false });
  return { model, anchors: anchorsOf(frames, given), read: await profilesFrom(services, subject, first, signal, looked) };
}

/** Reads the film at the first poses of each component, in squares with sides of so many pixels. */
export async function readFirst(services: Services, subjects: readonly Subject[], side: number, signal: AbortSignal): Promise<readonly ReadProfiles[]> {
  const each = subjects.map(async (subject) => {
    const { component, worker, span, frames } = subject;
    const { model: _, ...input } = subjectOf(services, component);
    const given = span.given.slice(0, POSES);
    const first = await worker.call('readFilm', { ...input, component, frames: frames.length, side, given, justThere: true });
    return profilesFrom(services, subject, first, signal, () => undefined);
  });
  return (await Promise.all(each)).flat();
}

/** Reads the film in frames in which a followed component is good, as its worker chooses them; null where these are too few. */
export async function readAsked(services: Services, subject: Subject, otherMiddles: Float64Array<ArrayBuffer>, signal: AbortSignal): Promise<Beside | null> {
  const { component, worker, span, frames } = subject;
  const { model, ...input } = subjectOf(services, component);
  const side = squareOf(filmNumbers(services.store.doc, component));
  const first = await worker.call('askFilm', { ...input, component, frames: frames.length, side, otherMiddles });
  if (first === null) return null;
  const read = await profilesFrom(services, subject, first, signal, () => undefined);
  return { model, anchors: anchorsOf(frames, span.given.slice(0, POSES)), read };
}

function anchorsOf(frames: readonly FrameEntry[], given: readonly Given[]): Beside['anchors'] {
  return given.map(({ frame, pose }) => ({ frameId: frames[frame]!.id, pose }));
}

/** Profiles in all frames that the worker asks for. */
async function profilesFrom(services: Services, { component, worker, frames }: Subject, first: number | null, signal: AbortSignal, looked: () => void): Promise<readonly ReadProfiles[]> {
  const read: ReadProfiles[] = [];
  for (let next = first; next !== null && !signal.aborted; ) {
    const frame = next;
    const { frameId: _, ...input } = await frameAt(services, frames, frame);
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

/** A frame by its number among those that the work was begun with: others may have come between them since. */
export async function frameAt({ studio }: Pick<Services, 'studio'>, frames: readonly FrameEntry[], at: number): Promise<FramePixels & { readonly frameId: string }> {
  const frame = frames[at];
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
