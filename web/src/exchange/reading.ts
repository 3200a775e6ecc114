import type { Store } from '../document/store';
import { texts } from '../texts/texts';
import { Aborted } from '../workers/bridge';
import type { Incoming } from './incoming';
import { asJob } from '../jobs/services';

/** A file and the folders it came from, as far as the browser tells. */
export interface Located {
  readonly file: File;
  readonly path: string;
}

/** What systems leave in folders: nobody means these. */
const LEFT_BY_SYSTEMS = /^(\..*|thumbs\.db|desktop\.ini|dicomdir)$/i;

export function isMeant(path: string): boolean {
  const parts = path.split('/').filter((part) => part !== '');
  return parts.every((part) => part !== '__MACOSX') && !LEFT_BY_SYSTEMS.test(parts.at(-1) ?? '');
}

/** So few files need no telling how far they are, and so much is read at once. */
const FEW = 8;

/** Reads files one after the other; nothing when it is called off. What systems leave in folders is not read. */
export async function readFiles(store: Store, files: readonly Located[]): Promise<Incoming[]> {
  const meant = files.length > 1 ? files.filter(({ path }) => isMeant(path)) : files;
  const read = async ({ file, path }: Located): Promise<Incoming> => ({
    name: file.name,
    path,
    bytes: new Uint8Array(await file.arrayBuffer()),
  });
  if (meant.length <= FEW) return Promise.all(meant.map(read));
  const abort = new AbortController();
  const job = { title: texts.files.reading, unit: texts.files.files, total: meant.length, cancel: () => abort.abort(new Aborted()) };
  return asJob(store, job, async (report) => {
    const all: Incoming[] = [];
    for (const file of meant) {
      abort.signal.throwIfAborted();
      all.push(await read(file));
      report(all.length, meant.length);
    }
    return all;
  });
}
