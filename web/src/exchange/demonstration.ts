import * as commands from '../document/commands';
import { list, object, oneOf, text, type Reader } from '../document/reader';
import { EMPTY_DOC } from '../document/types';
import type { ComponentName } from '../terms/component';
import { addressOf } from './address';
import { openFiles } from './opener';
import type { Incoming } from './incoming';
import { asJob, type Services } from '../jobs/services';
import { texts } from '../texts/texts';
import { Aborted } from '../workers/bridge';

const FOLDER = 'demo/';

interface Manifest {
  readonly name: string;
  readonly side: 'left' | 'right';
  readonly calibration: string;
  readonly frames: readonly string[];
  readonly models: Readonly<Record<ComponentName, string>>;
}

const readManifest: Reader<Manifest> = object<Manifest>({
  name: text,
  side: oneOf('left', 'right'),
  calibration: text,
  frames: list(text),
  models: object({ femur: text, tibia: text }),
});

/** Opens the built-in sequence with its calibration and models, and no outlines: those are for the person to trace. */
export async function openDemonstration(services: Services): Promise<void> {
  const { store } = services;
  const untouched = store.doc === EMPTY_DOC;
  const abort = new AbortController();
  const job = { title: texts.said.demonstration, unit: '', total: 0, cancel: () => abort.abort(new Aborted()) };
  const { manifest, files } = await asJob(store, job, () => fetchedAll(abort.signal));
  if (!(await openFiles(services, files))) return;
  store.perform(commands.rename(manifest.name));
  store.perform(commands.setSide(manifest.side));
  store.goTo(0);
  if (untouched) store.settle();
}

async function fetchedAll(signal: AbortSignal): Promise<{ readonly manifest: Manifest; readonly files: readonly Incoming[] }> {
  const manifest = readManifest(await (await fetched('demo.json', signal)).json(), 'demo.json');
  const { calibration, frames, models } = manifest;
  const incoming = async (name: string, component?: ComponentName): Promise<Incoming> => {
    const blob = await (await fetched(name, signal)).blob();
    return { name: name.split('/').at(-1) ?? name, blob, component };
  };
  const others = [calibration, ...frames].map((name) => incoming(name));
  return { manifest, files: await Promise.all([...others, incoming(models.femur, 'femur'), incoming(models.tibia, 'tibia')]) };
}

async function fetched(name: string, signal: AbortSignal): Promise<Response> {
  const response = await fetch(addressOf(FOLDER + name), { signal });
  if (!response.ok) throw new Error(texts.said.notFetched(name, response.status));
  return response;
}
