import { cellOf, type Doc, type Outline } from '../document/types';
import { poseTable } from '../document/session/table';
import { writeCoco } from '../exchange/coco';
import { download } from '../exchange/browser_files';
import { fileStem, sessionName } from '../terms/file_name';
import { exportMasks } from '../exchange/exporter';
import { writeOutlines } from '../exchange/outline_file';
import { posesOf } from '../exchange/pose_rows';
import { publishedFilm } from '../exchange/publish';
import { sentenceOf } from '../jobs/services';
import { asWritten } from '../results/outdated';
import { COMPONENT_NAMES } from '../terms/component';
import type { Exporting, ExportKind } from '../terms/exporting';
import { PROGRAM } from '../terms/program';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import { Aborted } from '../workers/bridge';
import type { JointText } from '../workers/protocol/joint';
import type { FilmType } from '../workers/protocol/overlay';
import type { App } from './app';
import { pngOf } from './figure_png';
import { overlayLook, writeOverlayFilm } from './overlay_film';

/** A file on its way out. */
interface Made {
  readonly part: BlobPart;
  readonly type: string;
}

const TEXT_TYPES: Readonly<Partial<Record<ExportKind, string>>> = { figure: 'image/svg+xml', report: 'text/html', outlines: 'application/json' };

/** How a file is called. `film`: what kind this browser writes. */
export function fileName({ name, frames }: Doc, { kind, forms, component, column }: Exporting, frameIndex: number, film: FilmType | null): string {
  const stem = fileStem(name);
  switch (kind) {
    case 'session':
      return forms.session === 'study' ? 'study.toml' : sessionName(name, forms.session === 'whole');
    case 'results':
      return `${stem}_results.zip`;
    case 'poses':
      if (forms.poses === 'tra') return `${stem}.tra`;
      if (forms.poses === 'jtap') return `${stem}_${component}_frame_${String(Math.min(frameIndex, frames.length - 1) + 1).padStart(4, '0')}.jtap`;
      if (forms.poses === 'folder') return `${stem}_poses.zip`;
      return `${stem}_${component}.${forms.poses}`;
    case 'joint':
      return { csv: `${stem}_joint.csv`, mot: `${stem}.mot`, cycle: `${stem}_cycle_${column}.csv` }[forms.joint];
    case 'figure':
      return `${stem}_figure.${forms.figure}`;
    case 'report':
      return `${stem}_report.html`;
    case 'film':
      return forms.film === 'pictures' ? `${stem}_overlay.zip` : `${stem}_overlay.${film ?? 'mp4'}`;
    case 'outlines':
      return { outlines: `${stem}.outlines.json`, coco: `${stem}.coco.json`, masks: `${stem}_masks.zip` }[forms.outlines];
  }
}

/** The text that a file will hold, for those that are one; null for the others. */
export async function textOf(app: App, { kind, forms, component, column }: Exporting): Promise<string | null> {
  const { store, studio } = app.services;
  const { ui } = store;
  const doc = asWritten(store.doc);
  const publish = async (what: JointText) => app.joint.publish(await publishedFilm(doc, app.joint.numbers), what);
  switch (kind) {
    case 'session':
      return forms.session === 'study' ? (await import('../exchange/study_text')).writeStudy(doc) : null;
    case 'joint':
      return publish(forms.joint === 'cycle' ? { form: 'cycle', column } : { form: forms.joint === 'csv' ? 'table' : 'mot' });
    case 'figure':
      return publish({ form: 'figure' });
    case 'results':
    case 'report':
      return publish({ form: 'report' });
    case 'outlines':
      if (forms.outlines === 'masks') return null;
      return forms.outlines === 'coco' ? writeCoco(doc, PROGRAM) : writeOutlines(doc, PROGRAM);
    case 'poses':
      if (forms.poses === 'folder') return (await import('../exchange/tracked')).statesOf(doc);
      if (forms.poses === 'jts') return studio.writePoses(posesOf(doc, component));
      if (forms.poses === 'csv') return poseTable(doc, component);
      if (forms.poses === 'jtak') return app.joint.poseText({ form: 'jtak', poses: posesOf(doc, component) });
      if (forms.poses === 'jtap') return app.joint.poseText({ form: 'jtap', poses: posesOf(doc, component).slice(ui.frameIndex, ui.frameIndex + 1) });
      return app.joint.poseText({ form: 'tra', poses: { femur: posesOf(doc, 'femur'), tibia: posesOf(doc, 'tibia') } });
    default:
      return null;
  }
}

/** Writes what the sheet shows, and says so. */
export async function write(app: App, exporting: Exporting, film: FilmType | null): Promise<void> {
  const { store } = app.services;
  const { doc, ui } = store;
  if (exporting.kind === 'session' && exporting.forms.session !== 'study') return app.actions.saveSession(exporting.forms.session === 'whole');
  const name = fileName(doc, exporting, ui.frameIndex, film);
  try {
    const made = await makeFile(app, exporting, film);
    if (!made) return store.say('info', later.exchange.noneClosed);
    download([made.part], name, made.type);
    store.say('info', savedWords(doc, exporting, name));
  } catch (error) {
    const isCalledOff = error instanceof Aborted;
    store.say(isCalledOff ? 'info' : 'error', isCalledOff ? later.exporting.called(name) : sentenceOf(error));
  }
}

async function makeFile(app: App, exporting: Exporting, film: FilmType | null): Promise<Made | null> {
  const { kind, forms } = exporting;
  const { services } = app;
  const doc = asWritten(services.store.doc);
  if (kind === 'film') return makeFilm(app, forms.film === 'pictures' ? 'pictures' : film);
  if (kind === 'outlines' && forms.outlines === 'masks') {
    const zip = await exportMasks(services);
    return zip && { part: zip, type: 'application/zip' };
  }
  if (kind === 'figure' && forms.figure === 'pdf') {
    return { part: await app.joint.figurePdf(await publishedFilm(doc, app.joint.numbers)), type: 'application/pdf' };
  }
  if (kind === 'results' || (kind === 'poses' && forms.poses === 'folder')) {
    const packing = await import('./packing');
    return { part: await (kind === 'results' ? packing.resultsOf(app, doc) : packing.posesFolderOf(app, doc)), type: 'application/zip' };
  }
  const text = (await textOf(app, exporting)) ?? '';
  if (kind === 'figure' && forms.figure === 'png') return { part: await pngOf(text), type: 'image/png' };
  return { part: text, type: TEXT_TYPES[kind] ?? 'text/plain' };
}

async function makeFilm({ services, joint }: App, form: FilmType | 'pictures' | null): Promise<Made | null> {
  const look = overlayLook(services.store.doc, joint.numbers);
  if (!look || !form) return null;
  const film = await writeOverlayFilm(services, look, form);
  return { part: film, type: film.type };
}

function savedWords(doc: Doc, exporting: Exporting, name: string): string {
  const { kind, component, forms } = exporting;
  if (kind === 'poses' && (forms.poses === 'csv' || forms.poses === 'jts' || forms.poses === 'jtak')) {
    const poses = posesOf(doc, component);
    const missing = poses.filter((pose) => !pose).length;
    return forms.poses === 'csv' ? texts.said.tableSaved(texts.component[component], poses.length) : texts.said.posesSaved(texts.component[component], poses.length, missing);
  }
  if (kind !== 'outlines') return later.exporting.saved(name);
  const outlines = outlinesOf(doc);
  if (forms.outlines === 'outlines') return later.exchange.saved(outlines.length, 0, 0);
  const closed = outlines.filter((outline) => outline.closed);
  return later.exchange.saved(closed.length, outlines.length - closed.length, closed.filter(({ unknownSides }) => unknownSides.length > 0).length);
}

export function outlinesOf(doc: Doc): Outline[] {
  const all = doc.frames.flatMap(({ id }) => COMPONENT_NAMES.map((component) => cellOf(doc, id, component).outline));
  return all.filter((outline) => outline !== null);
}
