import { componentIn, type Study } from '../document/study';
import { texts } from '../texts/texts';
import { textOf } from './incoming';
import { fewNames, troubleOf } from './outcome';
import type { Recognised } from './recognise';

/** A study says which of the files beside it is what; what it tells of the models is taken once they are here. */
export async function studyAmong(files: readonly Recognised[], failed: string[]): Promise<StudyFile | null> {
  const file = files.find(({ kind }) => kind === 'study');
  if (!file) return null;
  try {
    const { readStudy } = await import('./study_file');
    return { name: file.name, study: readStudy(await textOf(file)) };
  } catch (error) {
    failed.push(troubleOf(file.name, error));
    return null;
  }
}

export interface StudyFile {
  readonly name: string;
  readonly study: Study;
}

/** Files with the components that the study means. Where it names its reference poses, others are those of other methods. */
export function asTheStudyMeans({ study }: StudyFile, files: readonly Recognised[], leftOut: string[]): readonly Recognised[] {
  const meant = files.map((file): Recognised => {
    const said = file.kind === 'model' ? componentIn(study, 'model', file.name) : file.kind === 'poses' ? componentIn(study, 'reference', file.name) : undefined;
    return { ...file, component: file.component ?? said };
  });
  const poses = files.filter(({ kind }) => kind === 'poses');
  const others = poses.filter(({ name }) => !componentIn(study, 'reference', name));
  if (others.length === 0 || others.length === poses.length) return meant;
  leftOut.push(texts.study.otherPoses(others.length, fewNames(others)));
  return meant.filter(({ blob }) => !others.some((other) => other.blob === blob));
}

/** Where the study names the folder of its frames, pictures elsewhere are none: a report's figure, overlays. */
export function framesMeant(study: StudyFile | null, images: readonly Recognised[], leftOut: string[]): readonly Recognised[] {
  const folder = study?.study.frames?.replace(/^\.\//, '').replace(/\/$/, '');
  const isThere = ({ name, path }: Recognised) => `/${path ?? ''}`.endsWith(`/${folder}/${name}`);
  const others = images.filter((file) => !isThere(file));
  if (!folder || others.length === 0 || others.length === images.length) return images;
  leftOut.push(texts.study.otherImages(others.length, fewNames(others)));
  return images.filter(isThere);
}
