import { digestOf } from '../document/digest';
import type { Services } from '../jobs/services';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import type { FileKind } from '../workers/protocol/decode';
import { holdModel } from './bring_files';
import { componentFor, componentSaid } from './guess';
import { bytesOf, type Incoming } from './incoming';
import { fewNames } from './outcome';
import { nearest, parentOf, pathOf } from './paths';
import type { Recognised } from './recognise';

/** All files, where no study file could be read. Folders that have one each, or a calibration and frames, are studies of their own: none is taken. */
export function ofOneStudy(files: readonly Recognised[], failed: string[]): readonly Recognised[] {
  const foldersOf = (wanted: FileKind) => [...new Set(files.filter(({ kind }) => kind === wanted).map((file) => parentOf(pathOf(file))))];
  const [named, calibrated] = [foldersOf('study'), foldersOf('calibration')];
  const ofFrames = new Set(files.filter(({ kind }) => kind === 'frames').map((file) => nearest(calibrated, file)));
  const studies = named.length > 1 ? named : calibrated.filter((folder) => ofFrames.has(folder));
  if (studies.length < 2) return files;
  failed.push(later.opening.severalStudies(texts.listed(studies.map((folder) => folder || '.'))));
  return [];
}

/** Of several calibrations, or several models of a component, none is taken: a person opens the one that is meant. Models have their components. */
export async function withoutContested(services: Services, files: readonly Recognised[], failed: string[]): Promise<readonly Recognised[]> {
  const placed = await withPlaces(services, files);
  const groups = [
    { of: later.opening.calibrations, group: placed.filter(({ kind }) => kind === 'calibration') },
    ...COMPONENT_NAMES.map((component) => ({
      of: later.opening.modelsOf(texts.component[component]),
      group: placed.filter((file) => file.kind === 'model' && file.component === component),
    })),
  ];
  const contested: Recognised[] = [];
  for (const { of, group } of groups) {
    if (!(await areSeveral(group))) continue;
    failed.push(later.opening.contested(of, fewNames(group)));
    contested.push(...group);
  }
  return placed.filter((file) => !contested.includes(file));
}

/** Copies are one. Those that cannot be read are told when they are opened. */
async function areSeveral(files: readonly Incoming[]): Promise<boolean> {
  if (files.length < 2) return false;
  const digests = await Promise.all(files.map(({ blob }) => bytesOf(blob).then(digestOf, () => null)));
  return new Set(digests.filter((digest) => digest !== null)).size > 1;
}

/** Several models with the components that they are for, those first whose names or shapes tell. */
async function withPlaces(services: Services, files: readonly Recognised[]): Promise<readonly Recognised[]> {
  const { store } = services;
  const models = files.filter(({ kind }) => kind === 'model');
  if (models.length < 2) return files;
  const places = new Map<Recognised, ComponentName>();
  const untold: Recognised[] = [];
  for (const model of models) {
    const shaped = await shapeIn(services, model);
    const said = componentSaid(model, shaped ?? null);
    if (said) places.set(model, said);
    else if (shaped !== undefined) untold.push(model);
  }
  const isTaken = (component: ComponentName) => store.doc.components[component].model !== null || [...places.values()].includes(component);
  for (const model of untold) places.set(model, componentFor(store.state, model, isTaken));
  return files.map((file) => (places.has(file) ? { ...file, component: places.get(file) } : file));
}

/** The component that a model has the shape of; undefined where it cannot be read. */
async function shapeIn(services: Services, { name, blob }: Recognised): Promise<ComponentName | null | undefined> {
  try {
    const asset = await services.assets.add(name, blob);
    await holdModel(services, asset);
    return services.studio.shapeOf(asset.sha256);
  } catch {
    return undefined;
  }
}
