import { distinct } from '../document/same_frames';
import * as commands from '../document/commands';
import type { Doc, FrameEntry } from '../document/types';
import { asJob, type Services } from '../jobs/services';
import { later } from '../texts/later';
import { asSentence } from '../texts/sentences';
import { texts } from '../texts/texts';
import { type Decoded, decodeFrames } from './bring_files';
import type { Incoming } from './incoming';
import { byName } from './name_order';
import { attempt, fewNames, type Outcome } from './outcome';
import { TOLD } from './reading';
import type { WorkOnView } from './work_on_view';

/** Decodes files of frames, one after the other, and adds what they hold behind the frames that are here. */
export async function openFrames(services: Services, work: WorkOnView, files: readonly Incoming[], { opened, failed, news }: Outcome): Promise<void> {
  const abort = new AbortController();
  const decoded: Decoded[] = [];
  const job = {
    title: texts.said.openingFrames(files.length),
    unit: files.length === 1 ? texts.said.frames : texts.said.files,
    total: files.length,
    cancel: () => abort.abort(),
  };
  const lost: string[] = [];
  await asJob(services.store, job, async (report) => {
    for (const [index, file] of files.entries()) {
      // What was decoded until then stays.
      if (abort.signal.aborted || !work.isHere()) break;
      const reportFrames = (done: number, total: number) => files.length === 1 && report(done, total);
      const told = failed.length;
      await attempt(
        file,
        async () => {
          const asset = await services.assets.add(file.name, file.blob);
          decoded.push(...(await decodeFrames(services, asset, file.name, abort.signal, reportFrames)));
          return '';
        },
        { opened: [], failed },
      );
      if (failed.length > told) lost.push(file.name);
      if (files.length > 1 && ((index + 1) % TOLD === 0 || files.length < 4 * TOLD)) report(index + 1, files.length);
    }
  });
  if (!work.isHere()) return void failed.push(later.opening.tooLate(fewNames(files)));
  const entries = decoded.map(({ entry }) => entry);
  const isMended = entries.length > 0 && entries.every(({ name }) => services.store.doc.unread.includes(name));
  const unread = unreadAfter(services.store.doc, lost, entries);
  if (entries.length === 0) return keepUnread(services, unread);
  const added = addToDocument(services, distinct(entries), unread, isMended, files[0]?.path);
  work.follow();
  if (added.length > 0) opened.push(texts.said.theFrames(added.length, added[0]!.name));
  if (added.length < entries.length) news.push(later.opening.knownFrames(entries.length - added.length));
  news.push(...repeatsAmong(decoded), ...(await gapsAmong(services, files)));
}

/** Files of frames that could not be read, until they are opened mended: files of poses may have rows for them. */
function unreadAfter({ unread }: Doc, lost: readonly string[], came: readonly FrameEntry[]): readonly string[] {
  return [...unread.filter((name) => !lost.includes(name)), ...lost].filter((name) => !came.some((entry) => entry.name === name));
}

/** Without a frame there is no work yet that would have to know. */
function keepUnread({ store }: Services, unread: readonly string[]): void {
  if (store.doc.frames.length > 0) store.amend((doc) => ({ ...doc, unread }));
}

/** Returns those that were not here before. `isMended`: they could not be read when those beside them were opened, and have their places among them. */
function addToDocument(
  { store, studio }: Services,
  entries: readonly FrameEntry[],
  unread: readonly string[],
  isMended: boolean,
  path = '',
): readonly FrameEntry[] {
  const known = new Set(store.doc.frames.map(({ id }) => id));
  const first = known.size;
  const isByName = store.doc.frames.every(({ name }, at, all) => at === 0 || byName(all[at - 1]!.name, name) < 0);
  store.perform(commands.addFrames(entries, unread, isMended && isByName ? byName : undefined));
  // Frames that were here before may be of another film.
  const rate = first === 0 && entries.length > 1 ? (studio.statedGeometry(entries[0]!.id)?.rate ?? null) : null;
  if (rate !== null && store.doc.rate === null) store.amend((doc) => ({ ...doc, rate }));
  if (store.doc.name === '') store.amend((doc) => ({ ...doc, name: folderOf(path) ?? studyName(entries[0]!) }));
  if (store.doc.frames.length > first) store.goTo(isMended ? store.doc.frames.findIndex(({ id }) => id === entries[0]!.id) : first);
  return entries.filter(({ id }) => !known.has(id));
}

/** Pairs of frames that are named. */
const NAMED = 3;

/** Neighbours with the same picture: a film that stands still for a frame is rare, and one that was written twice is not. */
function repeatsAmong(decoded: readonly Decoded[]): readonly string[] {
  const pairs = decoded.flatMap(({ print, entry: { width } }, at) => {
    const next = decoded[at + 1];
    return next && next.print === print && next.entry.width === width ? [[at + 1, at + 2] as const] : [];
  });
  return pairs.length > 0 ? [texts.said.repeats(pairs.slice(0, NAMED), Math.max(pairs.length - NAMED, 0))] : [];
}

async function gapsAmong({ decoder }: Services, files: readonly Incoming[]): Promise<readonly string[]> {
  const told = await decoder.call('gapsAmong', { names: files.map(({ name }) => name) });
  return told === null ? [] : [asSentence(told)];
}

/** A film has frames of one size: another one is told when it comes, not when somebody follows the film. */
export function sizesAmong(frames: readonly FrameEntry[], came: number): readonly string[] {
  const [first] = frames;
  const other = came > 0 && frames.find(({ width, height }) => width !== first?.width || height !== first.height);
  return first && other ? [texts.said.sizes(other, first)] : [];
}

/** The folder that was opened is what a person calls it. */
function folderOf(path: string): string | null {
  const parts = path.split('/').filter((part) => part !== '');
  return parts.length > 1 ? parts[0]! : null;
}

function studyName(frame: FrameEntry): string {
  const name = frame.name.replace(/ #\d+$/, '').replace(/\.[a-z0-9]+$/i, '').replace(/[-_ ]*0*1?$/, '');
  // A number is no name of a study, nor what every film calls its frames.
  return /^(\d*|[a-z]|im|img|image|frame|slice|pic|picture|film|scan)$/i.test(name) ? texts.said.study : name;
}
