import * as commands from '../document/commands';
import { list, object, oneOf, text, type Reader } from '../document/reader';
import { EMPTY_DOC } from '../document/types';
import type { ComponentName } from '../terms/component';
import { addressOf } from './address';
import { openFiles } from './opener';
import type { Incoming } from './incoming';
import type { Services } from '../jobs/services';
import { texts } from '../texts/texts';

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
  store.say('info', texts.said.demonstration);
  const manifest = readManifest(await (await fetched('demo.json')).json(), 'demo.json');
  const names = [manifest.calibration, ...manifest.frames];
  const files = await Promise.all([
    ...names.map((name) => incoming(name)),
    incoming(manifest.models.femur, 'femur'),
    incoming(manifest.models.tibia, 'tibia'),
  ]);
  if (!(await openFiles(services, files))) return;
  store.perform(commands.rename(manifest.name));
  store.perform(commands.setSide(manifest.side));
  store.goTo(0);
  if (untouched) store.settle();
}

async function incoming(name: string, component?: ComponentName): Promise<Incoming> {
  const blob = await (await fetched(name)).blob();
  return { name: name.split('/').at(-1) ?? name, blob, component };
}

async function fetched(name: string): Promise<Response> {
  const response = await fetch(addressOf(FOLDER + name));
  if (!response.ok) throw new Error(texts.said.notFetched(name, response.status));
  return response;
}
