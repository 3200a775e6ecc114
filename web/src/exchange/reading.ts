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

/** What is to be opened; what systems leave in folders is not. */
export function meantFiles(files: readonly Located[]): readonly Incoming[] {
  const meant = files.length > 1 ? files.filter(({ path }) => isMeant(path)) : files;
  return meant.map(({ file, path }) => ({ name: file.name, path, blob: file }));
}

/** So few files need no telling how far they are. */
const FEW = 8;
/** Whoever waits is told after so many: of thousands each takes a moment. */
export const TOLD = 16;

/** Reading this much is not over at once, bytes. */
const LARGE = 8e6;

/** A page that is in view has painted by then, ms; one that is not would wait for ever for its next picture. */
const PAINTED = 50;

/** Says that there is much to read, and has it shown first: what comes next may hold the page. */
export async function saidWhereLarge(store: Store, files: readonly Incoming[]): Promise<void> {
  const bytes = files.reduce((sum, { blob }) => sum + blob.size, 0);
  if (bytes < LARGE) return;
  store.show({ notice: { kind: 'info', text: texts.files.readingMuch(Math.round(bytes / 1e6)), at: Date.now() } });
  await new Promise((resolve) => setTimeout(resolve, PAINTED));
}

/** The files with what `look` tells of each, one after the other; throws `Aborted` when it is called off. */
export async function lookedAt<T>(store: Store, files: readonly Incoming[], look: (file: Incoming) => Promise<T>): Promise<T[]> {
  if (files.length <= FEW) return Promise.all(files.map(look));
  const abort = new AbortController();
  const job = { title: texts.files.reading, unit: texts.files.files, total: files.length, cancel: () => abort.abort(new Aborted()) };
  return asJob(store, job, async (report) => {
    const all: T[] = [];
    for (const file of files) {
      abort.signal.throwIfAborted();
      all.push(await look(file));
      if (all.length % TOLD === 0) report(all.length, files.length);
    }
    return all;
  });
}
