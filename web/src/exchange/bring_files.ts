import type { Asset } from '../document/assets';
import type { Doc, FrameEntry } from '../document/types';
import type { Services } from '../jobs/services';
import { bytesOf } from './incoming';
import { troubleOf } from './trouble';
import { COMPONENT_NAMES } from '../terms/component';
import { ended } from '../texts/sentences';
import { texts } from '../texts/texts';

/**
 * Tells the studio of the frames of a document, and brings its models; returns the names of files that are not at hand. What is amiss with
 * one that is goes to `troubles`.
 */
export async function bringFiles(services: Services, doc: Doc, troubles: string[]): Promise<string[]> {
  const missing: string[] = [];
  for (const { id, name, source, indexInSource } of doc.frames) {
    const file = name.replace(/ #\d+$/, '');
    if (services.assets.get(source)) services.studio.knowFrame(id, { sha256: source, index: indexInSource });
    else if (!missing.includes(file)) missing.push(file);
  }
  // No part of the state: whoever brings frames into memory is told.
  services.store.show({});
  for (const component of COMPONENT_NAMES) {
    const { model, libraryFile } = doc.components[component];
    const asset = model && services.assets.get(model.sha256);
    if (asset) await holdModel(services, asset).catch((error: unknown) => void troubles.push(ended(troubleOf(asset.name, error))));
    else if (model) missing.push(model.name);
    if (libraryFile && !services.assets.get(libraryFile.sha256)) missing.push(libraryFile.name);
  }
  // Whoever draws the models: a frame that stands still would stay without them until the next change.
  services.store.show({});
  return missing;
}

/** Decodes a model and hands it to the studio; the document is left alone. What is to be said of it, the studio knows then. */
export async function holdModel(services: Services, asset: Asset): Promise<void> {
  if (services.studio.meshOf(asset.sha256)) return;
  if (!(await services.assets.check(asset))) throw new Error(texts.keep.damaged(asset.name));
  const mesh = await services.decoder.call('model', { bytes: await bytesOf(asset.blob), name: asset.name });
  services.studio.addModel(asset.sha256, mesh, await services.shapeOf(mesh));
}

/** A frame, and what tells its picture from others. */
export interface Decoded {
  readonly entry: FrameEntry;
  readonly print: number;
}

/** Decodes every frame of a file into the studio, by the name that it came with. Frames that were there already are not held twice. */
export async function decodeFrames(
  { decoder, studio }: Services,
  asset: Asset,
  fileName: string,
  signal: AbortSignal,
  report: (done: number, total: number) => void,
): Promise<readonly Decoded[]> {
  const entries: Decoded[] = [];
  await decoder.call('frames', { blob: asset.blob, name: fileName }, {
    signal,
    onProgress: ({ index, total, frame, print }) => {
      const id = `${asset.sha256.slice(0, 16)}:${index}`;
      studio.addFrame(id, { sha256: asset.sha256, index }, frame);
      const name = total === 1 ? fileName : `${fileName} #${index + 1}`;
      const { width, height } = frame;
      entries.push({ entry: { id, name, source: asset.sha256, indexInSource: index, width, height }, print });
      report(index + 1, total);
    },
  });
  return entries;
}
