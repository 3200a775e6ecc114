import type { Asset } from '../document/assets';
import type { Doc, FrameEntry } from '../document/types';
import { asJob, type Services } from '../jobs/services';
import { COMPONENT_NAMES } from '../terms/component';
import { texts } from '../texts/texts';

/** Brings the files that a document names into the studio; returns the names of those that are not at hand. */
export async function bringFiles(services: Services, doc: Doc, title: string): Promise<string[]> {
  const missing: string[] = [];
  const never = new AbortController().signal;
  const sources = new Map(doc.frames.map((frame) => [frame.source, frame.name.replace(/ #\d+$/, '')]));
  const total = sources.size;
  const job = { title, unit: texts.said.files, total, cancel: () => undefined };
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

/** Decodes a model and hands it to the studio; the document is left alone. What is to be said of it, the studio knows then. */
export async function holdModel(services: Services, asset: Asset): Promise<void> {
  if (services.studio.meshOf(asset.sha256)) return;
  const mesh = await services.decoder.call('model', { bytes: asset.bytes, name: asset.name });
  services.studio.addModel(asset.sha256, mesh);
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
      studio.addFrame(id, frame);
      const name = total === 1 ? asset.name : `${asset.name} #${index + 1}`;
      const { width, height } = frame;
      entries.push({ id, name, source: asset.sha256, indexInSource: index, width, height });
      report(index + 1, total);
    },
  });
  return entries;
}
