import type { Study } from '../document/study';
import type { ComponentName } from '../terms/component';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import type { FileKind } from '../workers/protocol/decode';
import { textOf } from './incoming';
import { byName } from './name_order';
import { fewNames } from './outcome';
import { fileName, nearest, parentOf, pathOf, resolved } from './paths';
import type { Recognised } from './recognise';
import { troubleOf } from './trouble';

export interface StudyFile {
  readonly name: string;
  /** From here its paths are written. */
  readonly folder: string;
  readonly study: Study;
}

/** A study says which of the files beside it is what; what it tells of the models is taken once they are here. */
export async function studyAmong(files: readonly Recognised[], failed: string[]): Promise<StudyFile | null> {
  const [file, ...others] = studiesAmong(files);
  if (!file) return null;
  try {
    const { readStudy } = await import('./study_file');
    const study = readStudy(await textOf(file));
    if (others.length > 0) failed.push(later.opening.otherStudies(pathOf(file), others.length, fewNames(others)));
    return { name: file.name, folder: parentOf(pathOf(file)), study };
  } catch (error) {
    failed.push(troubleOf(file.name, error));
    return null;
  }
}

/** The highest one first: those of old copies lie below. */
function studiesAmong(files: readonly Recognised[]): readonly Recognised[] {
  const depth = (file: Recognised) => pathOf(file).split('/').length;
  return files.filter(({ kind }) => kind === 'study').sort((a, b) => depth(a) - depth(b) || byName(pathOf(a), pathOf(b)));
}

/** Files with the components that the study means. What it does not name, where it names such, is left out, and so is what lies with other studies. */
export function asTheStudyMeans(found: StudyFile, files: readonly Recognised[], leftOut: string[]): readonly Recognised[] {
  const { calibration, parts } = found.study;
  const folders = studiesAmong(files).map((file) => parentOf(pathOf(file)));
  const isNear = (file: Recognised) => (nearest(folders, file) ?? found.folder) === found.folder;
  const meant = new Map<Recognised, ComponentName | undefined>();
  const take = (kind: FileKind, written: string | null | undefined, component?: ComponentName) => {
    const file = written && meantBy(found, written, files.filter((candidate) => candidate.kind === kind), isNear);
    if (file) meant.set(file, component);
  };
  take('calibration', calibration);
  for (const { component, model, reference } of parts) {
    take('model', model, component);
    take('poses', reference, component);
  }
  const near = files.filter((file) => meant.has(file) || isNear(file));
  const unnamed = near.filter((file) => !meant.has(file) && namesSuch(found.study, file.kind));
  if (unnamed.length > 0) leftOut.push(later.opening.notNamed(unnamed.length, fewNames(unnamed), texts.listed(writtenIn(found.study))));
  const otherPoses = near.filter((file) => file.kind === 'poses' && !meant.has(file));
  const isReferenceHere = near.some((file) => file.kind === 'poses' && meant.has(file));
  if (isReferenceHere && otherPoses.length > 0) leftOut.push(later.study.otherPoses(otherPoses.length, fewNames(otherPoses)));
  const isOut = (file: Recognised) => unnamed.includes(file) || (isReferenceHere && otherPoses.includes(file));
  return near.filter((file) => !isOut(file)).map((file) => ({ ...file, component: file.component ?? meant.get(file) }));
}

/** The file at a path; where it is not there, as nobody told the folders or the study does not, the only one of that name. */
function meantBy({ folder }: StudyFile, written: string, files: readonly Recognised[], isNear: (file: Recognised) => boolean): Recognised | undefined {
  const path = resolved(folder, written);
  const there = files.find((file) => pathOf(file) === path);
  const [only, another] = files.filter((file) => isNear(file) && file.name === fileName(written));
  return there ?? (another ? undefined : only);
}

function namesSuch({ calibration, parts }: Study, kind: FileKind): boolean {
  return kind === 'calibration' ? calibration !== undefined : kind === 'model' && parts.some(({ model }) => model !== null);
}

function writtenIn({ calibration, parts }: Study): readonly string[] {
  return [calibration, ...parts.map(({ model }) => model)].filter((written) => typeof written === 'string');
}

/** Where the study names the folder of its frames, or the file that holds them all, pictures elsewhere are none: a report's figure, overlays. */
export function framesMeant(found: StudyFile | null, images: readonly Recognised[], leftOut: string[]): readonly Recognised[] {
  const written = found?.study.frames;
  if (!found || !written) return images;
  const folders = [resolved(found.folder, written), resolved('', written)];
  const places = (file: Recognised) => [pathOf(file), parentOf(pathOf(file))];
  const there = images.filter((file) => places(file).includes(folders[0] ?? ''));
  const meant = there.length > 0 ? there : images.filter((file) => places(file).some((place) => `/${place}`.endsWith(`/${folders[1]}`)));
  if (meant.length === 0 || meant.length === images.length) return images;
  const others = images.filter((file) => !meant.includes(file));
  leftOut.push(later.study.otherImages(others.length, fewNames(others)));
  return meant;
}
