import { setModel } from '../document/commands';
import type { Services } from '../jobs/services';
import type { ComponentName } from '../terms/component';
import { unitOf } from '../terms/length_unit';
import { later } from '../texts/later';
import { holdModel } from './bring_files';
import { stlOf } from './stl';

/**
 * Writes a component's model again in millimetres, as a person says in which unit its file is, and takes that for the model: from here
 * on it is a file like others, which goes with the session, and one step back brings the first one.
 */
export async function takeInMillimetres(services: Services, component: ComponentName, unitMm: number): Promise<void> {
  const { store, studio, assets } = services;
  const { model } = store.doc.components[component];
  const mesh = model && studio.meshOf(model.sha256);
  if (!model || !mesh) return;
  const name = inMillimetres(model.name);
  const asset = await assets.add(name, new Blob([stlOf(mesh, unitMm)]));
  await holdModel(services, asset);
  // Another may have been opened meanwhile.
  if (store.doc.components[component].model?.sha256 !== model.sha256) return;
  const unit = unitOf(unitMm);
  store.perform(setModel(component, { name, sha256: asset.sha256, ...(unit && { writtenFrom: { name: model.name, unit, sha256: model.sha256 } }) }));
  store.say('info', later.models.taken(model.name, name, unitMm));
}

function inMillimetres(name: string): string {
  return `${name.replace(/\.[^.]*$/, '')}_mm.stl`;
}
