import { strToU8, zipSync } from 'fflate';
import type { Doc } from '../document/types';
import { posesOf } from '../exchange/pose_rows';
import { publishedFilm } from '../exchange/publish';
import { trackedFiles } from '../exchange/tracked';
import type { ComponentName } from '../terms/component';
import type { App } from './app';

/** Several files in one: a folder, packed. */
type Packed = Uint8Array<ArrayBuffer>;

/** The poses as `track` writes them: what the commands take. */
export function posesFolderOf(app: App, doc: Doc): Packed {
  return packed(posesFiles(app, doc));
}

/** What `report` writes of a film, and the poses that it is made from. */
export async function resultsOf(app: App, doc: Doc): Promise<Packed> {
  const { joint } = app;
  const film = () => publishedFilm(doc, joint.numbers);
  const written = async (name: string, form: 'table' | 'mot' | 'figure' | 'report') => [name, strToU8(await joint.publish(await film(), { form }))] as const;
  const made = await Promise.all([
    written('joint.csv', 'table'),
    ...(doc.rate === null ? [] : [written('joint.mot', 'mot')]),
    written('figure.svg', 'figure'),
    film().then(async (of) => ['figure.pdf', await joint.figurePdf(of)] as const),
    written('report.html', 'report'),
  ]);
  return packed([...made, ...posesFiles(app, doc).map(([name, bytes]) => [`poses/${name}`, bytes] as const)]);
}

type File = readonly [name: string, bytes: Uint8Array];

function posesFiles({ services }: App, doc: Doc): readonly File[] {
  const jts = (component: ComponentName) => services.studio.writePoses(posesOf(doc, component));
  return trackedFiles(doc, { femur: jts('femur'), tibia: jts('tibia') }).map(([name, text]) => [name, strToU8(text)]);
}

function packed(files: readonly File[]): Packed {
  return zipSync(Object.fromEntries(files)) as Packed;
}
