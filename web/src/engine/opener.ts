import * as commands from '../document/commands';
import type { Asset } from '../document/assets';
import { readSession } from '../document/session';
import { COMPONENT_NAMES, type ComponentName, type Doc, type FrameEntry } from '../document/types';
import { Aborted } from '../worker/bridge';
import { componentFor } from './guess';
import { inWords } from './missing';
import type { FileKind } from './protocol';
import { asJob, sentenceOf, type Services } from './services';

/** A file as it came, from a button, a drop or an address. */
export interface Incoming {
  readonly name: string;
  readonly bytes: Uint8Array<ArrayBuffer>;
  /** Where the person said what it is for. */
  readonly component?: ComponentName | undefined;
}

interface Recognised extends Incoming {
  readonly kind: FileKind;
}

/**
 * Opens whatever it is given: each file is recognised by its content. A file that cannot be read is named and the
 * others are opened all the same.
 */
export async function openFiles(services: Services, files: readonly Incoming[]): Promise<void> {
  const recognised: Recognised[] = [];
  for (const file of files) recognised.push({ ...file, kind: await recognise(services, file) });
  recognised.sort((a, b) => ORDER.indexOf(a.kind) - ORDER.indexOf(b.kind) || byName(a.name, b.name));
  const opened: string[] = [];
  const failed: string[] = [];
  const frames = recognised.filter((file) => file.kind === 'frames');
  for (const file of recognised.filter((file) => file.kind !== 'frames' && file.kind !== 'poses')) {
    await attempt(file, () => openOne(services, file, failed), opened, failed);
  }
  if (frames.length > 0) await openFrames(services, frames, opened, failed);
  for (const file of recognised.filter((file) => file.kind === 'poses')) {
    await attempt(file, () => openPoses(services, file), opened, failed);
  }
  tell(services, opened, failed);
}

/** A session first: it replaces everything. Frames before poses: poses are for frames. */
const ORDER: readonly FileKind[] = ['session', 'calibration', 'model', 'library', 'frames', 'poses', 'unknown'];

function byName(a: string, b: string): number {
  return a.localeCompare(b, undefined, { numeric: true });
}

async function recognise({ decoder }: Services, { bytes, name }: Incoming): Promise<FileKind> {
  return decoder.call('sniff', { bytes, name });
}

async function attempt(
  file: Incoming,
  open: () => Promise<string>,
  opened: string[],
  failed: string[],
): Promise<void> {
  try {
    opened.push(await open());
  } catch (error) {
    if (!(error instanceof Aborted)) failed.push(named(file.name, sentenceOf(error)));
  }
}

/** The sentence with the file's name, which some begin with already. */
function named(name: string, sentence: string): string {
  return sentence.startsWith(name) ? sentence : `${name}: ${sentence}`;
}

function tell({ store }: Services, opened: readonly string[], failed: readonly string[]): void {
  if (opened.length > 0) store.say('info', `Opened ${opened.join(', ')}.`);
  for (const sentence of failed) store.say('error', sentence);
}

/** Says what was opened; what is amiss all the same goes to `remarks`. */
async function openOne(services: Services, file: Recognised, remarks: string[]): Promise<string> {
  switch (file.kind) {
    case 'calibration':
      return openCalibration(services, file);
    case 'model':
      return openModel(services, file);
    case 'library':
      return openLibrary(services, file);
    case 'session':
      return openSession(services, file, remarks);
    default:
      if (file.bytes.length === 0) throw new Error('the file is empty; export or copy it again');
      throw new Error(
        'not recognised; the page opens frames (PNG, JPEG, TIFF, DICOM), models (STL, OBJ, PLY), calibrations, .jts poses, libraries and sessions',
      );
  }
}

// --- Each kind ----------------------------------------------------------------------------------------------------

async function openCalibration({ store, studio }: Services, { name, bytes }: Incoming): Promise<string> {
  const text = new TextDecoder().decode(bytes);
  // Against the frames' size, where it is known.
  studio.calibrationFacts(text, store.doc.frames[0] ?? null);
  store.perform(commands.setCalibration({ name, text }));
  return `the calibration ${name}`;
}

async function openModel(services: Services, file: Incoming): Promise<string> {
  const { store, assets } = services;
  const asset = await assets.add(file.name, file.bytes);
  const component = componentFor(store.state, file, (candidate) => store.doc.components[candidate].model !== null);
  await holdModel(services, asset);
  const known = store.doc.components[component].model?.sha256 === asset.sha256;
  if (!known) store.perform(commands.setModel(component, { name: file.name, sha256: asset.sha256 }));
  return `${file.name} as the model of the ${component}`;
}

/** Decodes a model and lends it to the studio; the document is left alone. */
async function holdModel(services: Services, asset: Asset): Promise<void> {
  if (services.studio.meshOf(asset.sha256)) return;
  const mesh = await services.decoder.call('model', { bytes: asset.bytes, name: asset.name });
  services.studio.addModel(asset.sha256, mesh);
}

async function openLibrary({ store, studio, assets }: Services, file: Incoming): Promise<string> {
  studio.checkLibrary(file.bytes);
  const asset = await assets.add(file.name, file.bytes);
  const component = componentFor(store.state, file, (candidate) => store.doc.components[candidate].libraryFile !== null);
  store.perform(commands.setLibraryFile(component, { name: file.name, sha256: asset.sha256 }));
  return `${file.name} as the library of the ${component}`;
}

async function openPoses({ store, studio }: Services, file: Incoming): Promise<string> {
  const poses = studio.readPoses(new TextDecoder().decode(file.bytes));
  const frames = store.doc.frames.length;
  if (frames === 0) throw new Error('the poses are for frames: open the frames first, then the poses');
  const component = componentFor(store.state, file, () => false);
  store.perform(commands.loadPoses(component, poses, file.name));
  const surplus = poses.length === frames ? '' : ` (${poses.length} rows for ${frames} frames: in order, from the first)`;
  return `${file.name} as poses of the ${component}${surplus}`;
}

// --- Frames -------------------------------------------------------------------------------------------------------

async function openFrames(
  services: Services,
  files: readonly Incoming[],
  opened: string[],
  failed: string[],
): Promise<void> {
  const abort = new AbortController();
  const entries: FrameEntry[] = [];
  const job = {
    title: files.length === 1 ? 'Opening frames' : `Opening ${files.length} files of frames`,
    unit: files.length === 1 ? 'frames' : 'files',
    total: files.length,
    cancel: () => abort.abort(),
  };
  await asJob(services.store, job, async (report) => {
    for (const [index, file] of files.entries()) {
      const reportFrames = (done: number, total: number) => files.length === 1 && report(done, total);
      await attempt(
        file,
        async () => {
          const asset = await services.assets.add(file.name, file.bytes);
          entries.push(...(await decodeFrames(services, asset, abort.signal, reportFrames)));
          return '';
        },
        [],
        failed,
      );
      if (files.length > 1) report(index + 1, files.length);
    }
  });
  if (entries.length === 0) return;
  addToDocument(services, entries);
  opened.push(entries.length === 1 ? `the frame ${entries[0]!.name}` : `${entries.length} frames`);
}

function addToDocument({ store }: Services, entries: readonly FrameEntry[]): void {
  const first = store.doc.frames.length;
  store.perform(commands.addFrames(entries));
  if (store.doc.name === '') store.amend((doc) => ({ ...doc, name: studyName(entries[0]!) }));
  if (store.doc.frames.length > first) store.goTo(first);
}

/** Decodes every frame of a file into the studio. Frames that were there already are not held twice. */
export async function decodeFrames(
  { decoder, studio }: Services,
  asset: Asset,
  signal: AbortSignal,
  report: (done: number, total: number) => void,
): Promise<FrameEntry[]> {
  const entries: FrameEntry[] = [];
  await decoder.call('frames', { bytes: asset.bytes, name: asset.name }, {
    signal,
    onProgress: ({ index, total, frame }) => {
      const id = `${asset.sha256.slice(0, 16)}:${index}`;
      studio.addFilm(id, frame);
      const name = total === 1 ? asset.name : `${asset.name} #${index + 1}`;
      const { width, height } = frame;
      entries.push({ id, name, source: asset.sha256, indexInSource: index, width, height });
      report(index + 1, total);
    },
  });
  return entries;
}

function studyName(frame: FrameEntry): string {
  return frame.name.replace(/ #\d+$/, '').replace(/\.[a-z0-9]+$/i, '').replace(/[-_ ]*0*1?$/, '') || 'Study';
}

// --- Sessions -----------------------------------------------------------------------------------------------------

async function openSession(services: Services, file: Incoming, remarks: string[]): Promise<string> {
  const session = readSession(new TextDecoder().decode(file.bytes));
  const damaged: string[] = [];
  for (const included of session.files) {
    if (!included.bytes) continue;
    const asset = await services.assets.add(included.name, included.bytes);
    if (asset.sha256 !== included.sha256) damaged.push(included.name);
  }
  const missing = await bringFiles(services, session.doc, 'Opening the session');
  const { store } = services;
  // A command like any other: undo brings back what was open before.
  store.perform({ label: 'open a session', apply: () => session.doc });
  store.markSaved(store.doc);
  const { frameIndex, component, overlayOpacity } = session.view;
  store.show({ component, overlayOpacity: Math.min(1, Math.max(0, overlayOpacity)), viewport: null, savedAt: null });
  store.goTo(frameIndex);
  for (const name of damaged) remarks.push(`${name}: the copy in the session was changed; drop the original on the page`);
  if (missing.length > 0) remarks.push(`The session only names ${inWords(missing)}: drop ${missing.length === 1 ? 'it' : 'them'} on the page`);
  return `the session ${file.name}`;
}

/** Brings the files that a document names into the studio; returns the names of those that are not at hand. */
export async function bringFiles(services: Services, doc: Doc, title: string): Promise<string[]> {
  const missing: string[] = [];
  const never = new AbortController().signal;
  const sources = new Map(doc.frames.map((frame) => [frame.source, frame.name.replace(/ #\d+$/, '')]));
  const total = sources.size;
  const job = { title, unit: 'files', total, cancel: () => undefined };
  await asJob(services.store, job, async (report) => {
    let done = 0;
    for (const [sha256, name] of sources) {
      const asset = services.assets.get(sha256);
      if (asset) await decodeFrames(services, asset, never, () => undefined);
      else missing.push(name);
      report(++done, total);
    }
  });
  for (const component of COMPONENT_NAMES) {
    const { model, libraryFile } = doc.components[component];
    const asset = model && services.assets.get(model.sha256);
    if (asset) await holdModel(services, asset);
    else if (model) missing.push(model.name);
    if (libraryFile && !services.assets.get(libraryFile.sha256)) missing.push(libraryFile.name);
  }
  return missing;
}
