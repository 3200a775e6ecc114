import { holdModel } from './bring_files';
import { ofOneStudy, withoutContested } from './contested';
import { inTurn, isOpening } from './in_turn';
import { bytesOf, type Incoming, textOf } from './incoming';
import { byName } from './name_order';
import { ended } from '../texts/sentences';
import { lookedAt, saidWhereLarge } from './reading';
import * as commands from '../document/commands';
import { droppedIn } from '../document/found_anew';
import { readDistortionFile } from '../document/distortion';
import { takeStudy } from '../document/study';
import type { Doc } from '../document/types';
import { COMPONENT_NAMES, otherThan } from '../terms/component';
import { later } from '../texts/later';
import { UNITS_MM } from '../terms/length_unit';
import { texts } from '../texts/texts';
import { openFrames, sizesAmong } from './frames_opener';
import { atHand, componentFor } from './guess';
import { attempt, fewNames, noOutcome, type Outcome } from './outcome';
import { fileName } from './paths';
import { rowsOfFrames } from './pose_rows';
import { type Recognised, recognise } from './recognise';
import { offerStatedOrder } from './stated_order';
import { asTheStudyMeans, framesMeant, studyAmong, type StudyFile } from './study_files';
import { setsToAsk, sortedPoses, type SortedPoses } from './pose_sets';
import type { OutlineFile } from './importer';
import type { Offer } from '../document/store';
import { areOthers, stepAside } from './another_study';
import { cameraKey, newCameraDoubts } from '../jobs/camera_doubts';
import { takeDistortion } from '../jobs/take_distortion';
import type { FileKind, StatedGeometry } from '../workers/protocol/decode';
import type { Services } from '../jobs/services';
import { mismatchOf, openSession } from './session_opener';
import { troubleOf } from './trouble';
import type { WorkOnView } from './work_on_view';

/**
 * Opens whatever it is given, once what came before is opened: each file is recognised by its content. A file that cannot be read is named and
 * the others are opened all the same. True where the work that they are for is still on view.
 */
export function openFiles(services: Services, files: readonly Incoming[], beginVideo: BeginVideo = () => undefined): Promise<boolean> {
  if (isOpening(services.store)) services.store.say('info', later.opening.waits(fewNames(files)));
  return inTurn(services.store, (work) => openAll(services, work, files, beginVideo));
}

async function openAll(services: Services, work: WorkOnView, files: readonly Incoming[], beginVideo: BeginVideo): Promise<void> {
  const { store } = services;
  const before = cameraKey(services);
  await saidWhereLarge(store, files);
  const outcome = noOutcome();
  const { opened, failed, leftOut } = outcome;
  const all = await recognised(services, files, failed);
  const study = await studyAmong(all, failed);
  const meant = study ? asTheStudyMeans(study, all, leftOut) : ofOneStudy(all, failed);
  const outlines = await outlineFiles(services, meant, outcome.news);
  const others = meant.filter((file) => !outlines.some(({ blob }) => blob === file.blob));
  const frames = framesMeant(study, others.filter((file) => file.kind === 'frames'), leftOut);
  const isOther = isWhole(study, others) && (await areOthers(services, frames));
  if (!work.isHere()) return store.say('error', later.opening.tooLate(fewNames(files)));
  const aside = isOther ? stepAside(services) : null;
  if (aside) work.follow();
  await tellMismatches(services, meant, failed);
  // Of a whole folder what is not recognised is told in one sentence.
  const strangers = meant.length > 1 ? others.filter((file) => isStranger(file, others)) : [];
  const single = others.filter((file) => !LATER.includes(file.kind) && !strangers.includes(file));
  await openSingle(services, work, single, outcome);
  if (frames.length > 0) await openFrames(services, work, frames, outcome);
  const poses = sortedPoses(store.state, meant.filter((file) => file.kind === 'poses'));
  for (const file of poses.clear) await attempt(file, () => openPoses(services, work, file), outcome);
  if (study && work.isHere()) opened.push(await openStudy(services, study));
  if (strangers.length > 0) leftOut.push(texts.files.leftOut(strangers.length, fewNames(strangers)));
  await beginFirstVideo(others.filter((file) => file.kind === 'video'), beginVideo, failed);
  const isHere = work.isHere();
  if (isHere) {
    failed.push(...sizesAmong(store.doc.frames, frames.length), ...(await newCameraDoubts(services, before)));
    store.show({ component: atHand(store.doc, store.ui.component) });
  }
  // It stands in the line with what is shown last.
  if (aside) (failed.length > 0 ? failed : leftOut).unshift(aside.sentence);
  tell(services, outcome, aside?.offer);
  if (!isHere) return;
  offerStated(services, frames.length > 0);
  offerStatedOrder(services, frames.length > 0);
  askWhichPoses(services, work, poses);
  if (outlines.length > 0) await proposeOutlines(services, outlines, files);
}

/** A model in another form is none where it lies beside those that were exported from it. */
function isStranger({ kind, blob }: Recognised, among: readonly Recognised[]): boolean {
  return kind === 'unknown' ? blob.size > 0 : kind === 'other-model' && among.some((file) => file.kind === 'model');
}

/** A session has models that others stand beside. */
async function openSingle(services: Services, work: WorkOnView, files: readonly Recognised[], outcome: Outcome): Promise<void> {
  const open = (file: Recognised) => attempt(file, () => openOne(services, work, file, outcome.failed), outcome);
  for (const file of files.filter(({ kind }) => kind === 'session')) await open(file);
  const others = files.filter(({ kind }) => kind !== 'session');
  for (const file of await withoutContested(services, others, outcome.failed)) await open(file);
}

async function tellMismatches(services: Services, files: readonly Recognised[], failed: string[]): Promise<void> {
  for (const file of files.filter(({ kind }) => kind === 'frames' || kind === 'model' || kind === 'library')) {
    // One that cannot be read is told when it is opened.
    const sentence = await mismatchOf(services, file).catch(() => null);
    if (sentence) failed.push(sentence);
  }
}

/** The files by what they are, in the order of opening; those that cannot be read are told. */
async function recognised(services: Services, files: readonly Incoming[], failed: string[]): Promise<readonly Recognised[]> {
  const all = await lookedAt(services.store, files, (file) =>
    recognise(services, file).catch((error: unknown) => {
      failed.push(troubleOf(file.name, error));
      return null;
    }),
  );
  const read = all.filter((file) => file !== null);
  return read.sort((a, b) => ORDER.indexOf(a.kind) - ORDER.indexOf(b.kind) || byName(a.path ?? a.name, b.path ?? b.name));
}

/** All that a film needs comes with it: poses, models and calibration of another one would be wrong beside it. */
function isWhole(study: StudyFile | null, files: readonly Recognised[]): boolean {
  const has = (kind: FileKind) => files.some((file) => file.kind === kind);
  return has('frames') && (study !== null || (has('calibration') && has('model')));
}

/** Of several files of poses of a component nothing is taken before a person says which. */
function askWhichPoses(services: Services, work: WorkOnView, poses: SortedPoses<Recognised>): void {
  const { store } = services;
  const sets = setsToAsk(poses, (files) => void openChosenPoses(services, work, files));
  const component = COMPONENT_NAMES.find((name) => poses.contested[name].length > 0);
  if (!sets || !component) return;
  const choose = () => store.show({ popover: 'sets' });
  store.show({ poseSets: sets });
  store.say('info', texts.files.sets.ask(texts.component[component], fewNames(poses.contested[component])), { label: texts.files.sets.choose, take: choose });
  choose();
}

async function openChosenPoses(services: Services, work: WorkOnView, files: readonly Recognised[]): Promise<void> {
  const outcome = noOutcome();
  for (const file of files) await attempt(file, () => openPoses(services, work, file), outcome);
  tell(services, outcome);
}

/** Frames, poses, studies and videos have their own time. */
const LATER: readonly FileKind[] = ['frames', 'poses', 'study', 'video'];

/** What opens the first of the videos that were given. */
export type BeginVideo = (file: Incoming) => Promise<void> | undefined;

async function beginFirstVideo(videos: readonly Recognised[], begin: BeginVideo, failed: string[]): Promise<void> {
  const [first, ...others] = videos;
  if (!first) return;
  await attempt(first, async () => ((await begin(first)), ''), { opened: [], failed });
  if (others.length > 0) failed.push(texts.files.video.oneAtATime);
}

/** Frames that state sizes and distances: said once, with a button to look at them. Nothing is taken by itself. */
function offerStated({ store, studio }: Services, framesCame: boolean): void {
  const frame = store.doc.frames[store.ui.frameIndex];
  if (!framesCame || !frame || store.doc.calibration) return;
  const count = statesSomething(studio.statedGeometry(frame.id));
  if (count === 0) return;
  const { notice } = store.ui;
  const said = notice?.kind === 'info' ? `${notice.text} ` : '';
  if (notice?.kind === 'error') return;
  const look = () => store.show({ popover: 'calibration' });
  store.say('info', said + later.calibrate.stated.offer(count), { label: later.calibrate.stated.look, take: look });
}

/** How many values there are that a calibration may begin with. */
export function statesSomething(stated: StatedGeometry | null): number {
  return stated ? [stated.detectorSpacing, stated.scannedSpacing, stated.sourceToDetector].filter((value) => value !== null).length : 0;
}

/**
 * Files of outlines among others: those that say so, and images with no more grey values than a mask has, where there
 * are frames that they can be masks of. Where there are none it is said what becomes of them.
 */
async function outlineFiles({ store }: Services, files: readonly Recognised[], news: string[]): Promise<readonly OutlineFile[]> {
  const told = files.flatMap((file): OutlineFile[] => {
    const { kind } = file;
    return kind === 'outlines' || kind === 'coco' || kind === 'labelme' || kind === 'imagej' ? [{ ...file, kind }] : [];
  });
  const images = files.filter(({ kind }) => kind === 'frames');
  if (images.length === 0) return told;
  const { masksAmong } = await import('./importer');
  const masks = await masksAmong(store, images);
  const frames = store.doc.frames.length + images.length - masks.size;
  const found = images.filter((file) => masks.has(file)).map((file): OutlineFile => ({ ...file, kind: 'mask' }));
  if (frames > 0) return [...told, ...found];
  if (found.length > 1) news.push(later.opening.masksAlone(found.length));
  return told;
}

async function proposeOutlines(services: Services, outlines: readonly OutlineFile[], files: readonly Incoming[]): Promise<void> {
  const { store } = services;
  if (store.doc.frames.length === 0) {
    return store.say('error', texts.said.of(outlines[0]?.name ?? '', texts.said.outlinesNeedFrames));
  }
  const { propose } = await import('./importer');
  const masks = outlines.filter(({ kind }) => kind === 'mask').map(({ blob }) => blob);
  const images = files.filter(({ blob }) => masks.includes(blob));
  const asFrames = () => {
    void openAsFrames(services, images);
  };
  await propose(services, outlines, images.length > 0 ? asFrames : null);
}

/** Opens images as frames, whatever they look like. */
function openAsFrames(services: Services, files: readonly Incoming[]): Promise<boolean> {
  return inTurn(services.store, async (work) => {
    const outcome = noOutcome();
    await openFrames(services, work, files, outcome);
    if (work.isHere()) outcome.failed.push(...sizesAmong(services.store.doc.frames, files.length));
    tell(services, outcome);
  });
}

/** A session first: it replaces everything. Frames before poses: poses are for frames. */
const ORDER: readonly FileKind[] = [
  'session', 'calibration', 'distortion', 'study', 'model', 'library', 'frames', 'poses', 'outlines', 'coco', 'labelme', 'imagej', 'video', 'other-model', 'unknown',
];

/** So many sentences of what failed fit the line, which shows one notice; the list of messages has them all. */
const SHOWN = 3;

/** What was left out of a folder is news, no error: nobody asked for it. */
function tell({ store }: Services, { opened, failed, news, leftOut }: Outcome, offer?: Offer): void {
  const came = [...(opened.length > 0 ? [texts.said.opened(opened.join(', '))] : []), ...news];
  if (came.length + leftOut.length > 0) store.say(came.length > 0 ? 'info' : 'error', [...came, ...leftOut].join(' '), offer);
  if (failed.length === 0) return;
  for (const sentence of failed.slice(SHOWN)) store.say('error', sentence);
  const rest = failed.length - SHOWN;
  const more = rest > 0 ? [later.opening.andMoreFiles(rest)] : [];
  const [only = '', ...others] = [...failed.slice(0, SHOWN), ...more];
  store.say('error', others.length === 0 ? only : [only, ...others].map(ended).join(' '), offer);
}

/** Says what was opened; what is amiss all the same goes to `remarks`. */
async function openOne(services: Services, work: WorkOnView, file: Recognised, remarks: string[]): Promise<string> {
  switch (file.kind) {
    case 'calibration':
      return openCalibration(services, work, file);
    // What is in another form the reader refuses, and says what to do.
    case 'model':
    case 'other-model':
      return openModel(services, work, file);
    case 'library':
      return openLibrary(services, work, file);
    case 'session':
      return openSessionAs(services, work, file, remarks);
    case 'distortion':
      return openDistortion(services, work, file);
    default:
      if (file.blob.size === 0) throw new Error(texts.said.emptyFile);
      throw new Error(ARCHIVE.test(file.name) ? later.opening.archive : texts.said.notRecognised);
  }
}

/** By their names: documents and tables are zips too. */
const ARCHIVE = /\.(zip|rar|7z|tar|t?gz)$/i;

// --- Each kind ----------------------------------------------------------------------------------------------------

/** Throws where other work came on view while a file was read. */
function mustBeHere(work: WorkOnView, { name }: Incoming): void {
  if (!work.isHere()) throw new Error(later.opening.tooLate(name));
}

/** It brings a work of its own. */
async function openSessionAs(services: Services, work: WorkOnView, file: Incoming, remarks: string[]): Promise<string> {
  const said = await openSession(services, file, remarks);
  work.follow();
  return said;
}

async function openCalibration({ store, studio, ownCalibration }: Services, work: WorkOnView, file: Incoming): Promise<string> {
  const { name } = file;
  const given = await textOf(file);
  const text = studio.isCalibrationOfOthers(given) ? await ownCalibration(given) : given;
  mustBeHere(work, file);
  // Against the frames' size, where it is known.
  studio.calibrationFacts(text, store.doc.frames[0] ?? null);
  const before = store.doc;
  store.perform(commands.setCalibration({ name, text }));
  return texts.said.theCalibration(name) + droppedSince(before, store.doc);
}

/** What a replaced calibration or model took with it, in words; nothing where it did not. */
function droppedSince(before: Doc, after: Doc): string {
  const dropped = droppedIn(before, after);
  return dropped === 0 ? '' : ` (${later.opening.dropped(dropped)})`;
}

async function openDistortion(services: Services, work: WorkOnView, file: Incoming): Promise<string> {
  const distortion = readDistortionFile(await textOf(file));
  mustBeHere(work, file);
  takeDistortion(services, distortion);
  return texts.calibrate.opened(file.name);
}

async function openModel(services: Services, work: WorkOnView, file: Incoming): Promise<string> {
  const { store, assets } = services;
  const asset = await assets.add(file.name, file.blob);
  await holdModel(services, asset);
  mustBeHere(work, file);
  const shaped = services.studio.shapeOf(asset.sha256);
  const component = componentFor(store.state, file, (candidate) => store.doc.components[candidate].model !== null, shaped);
  const remarks = services.studio.remarksOn(asset.sha256);
  const before = store.doc;
  const { model } = before.components[component];
  const known = model?.sha256 === asset.sha256 || model?.writtenFrom?.sha256 === asset.sha256;
  if (!known) store.perform(commands.setModel(component, { name: file.name, sha256: asset.sha256 }));
  const named = texts.said.asModel(file.name, texts.component[component]) + droppedSince(before, store.doc);
  // What a person or a name says is done, and what the shape says is said.
  const opened = shaped === otherThan(component) ? later.models.besides(named, later.models.shape[component]) : named;
  return remarks.length === 0 ? opened : texts.files.modelNotes(opened, remarks.join('; '));
}

async function openStudy(services: Services, { name, study }: StudyFile): Promise<string> {
  const { store } = services;
  store.perform(takeStudy(study, name));
  for (const { component, model, unit } of study.parts) {
    const isOfFile = model !== null && store.doc.components[component].model?.name === fileName(model);
    if (!isOfFile || !unit || unit === 'mm') continue;
    const { takeInMillimetres } = await import('./model_unit');
    await takeInMillimetres(services, component, UNITS_MM[unit]);
  }
  return later.study.opened(study.name || name);
}

async function openLibrary({ store, assets, checkLibrary }: Services, work: WorkOnView, file: Incoming): Promise<string> {
  await checkLibrary(await bytesOf(file.blob));
  const asset = await assets.add(file.name, file.blob);
  mustBeHere(work, file);
  const component = componentFor(store.state, file, (candidate) => store.doc.components[candidate].libraryFile !== null);
  store.perform(commands.setLibraryFile(component, { name: file.name, sha256: asset.sha256 }));
  return texts.said.asLibrary(file.name, texts.component[component]);
}

async function openPoses({ store, studio }: Services, work: WorkOnView, file: Incoming): Promise<string> {
  const text = await textOf(file);
  mustBeHere(work, file);
  const poses = studio.readPoses(text);
  const { frames, unread } = store.doc;
  if (frames.length === 0) throw new Error(texts.said.posesNeedFrames);
  const component = componentFor(store.state, file, () => false);
  const rows = rowsOfFrames(poses.length, frames, unread);
  if (!rows) throw new Error(texts.said.otherRows(poses.length, frames.length, unread));
  store.perform(commands.loadPoses(component, rows.map((row) => poses[row] ?? null), file.name));
  const { asPoses, asPosesWithout } = texts.said;
  const of = texts.component[component];
  return poses.length === frames.length ? asPoses(file.name, of) : asPosesWithout(file.name, of, unread);
}
