import { openDB, type DBSchema, type IDBPDatabase } from 'idb';
import type { Asset } from '../document/assets';
import type { SessionView } from '../document/session/session';
import type { FileReference } from '../document/types';

/** A piece of work in the browser's storage, without its cells and the bytes of its files. */
export interface KeptWork {
  readonly id: string;
  readonly name: string;
  readonly frames: number;
  /** Milliseconds since 1970. */
  readonly savedAt: number;
  /** Left for other work: still here, but not what the next page begins with. */
  readonly putAside: boolean;
  /** What wrote it, and the version of a session file that its parts are like. */
  readonly program: string;
  readonly version: number;
  /** As in a session file, with no cells. */
  readonly document: Readonly<Record<string, unknown>>;
  readonly view: SessionView;
  readonly files: readonly FileReference[];
}

/** As in a session file; null deletes the cell. */
export interface CellChange {
  readonly key: string;
  readonly cell: unknown;
}

/** Pages of before kept the bytes themselves. */
interface KeptFile {
  readonly name: string;
  readonly sha256: string;
  readonly bytes: Blob | Uint8Array<ArrayBuffer>;
}

interface Schema extends DBSchema {
  works: { key: string; value: KeptWork };
  cells: { key: [work: string, cell: string]; value: unknown };
  files: { key: string; value: KeptFile };
}

const NAME = 'fluoropose';
const VERSION = 1;

/**
 * The browser's storage: works, their cells one by one, so that a change writes little, and the bytes of files by
 * their SHA-256, once however many works name them.
 */
export class Shelf {
  readonly #database: IDBPDatabase<Schema>;

  private constructor(database: IDBPDatabase<Schema>) {
    this.#database = database;
  }

  /** `onLost` hears of it when the browser takes the storage away. */
  static async open(onLost: () => void): Promise<Shelf> {
    const database = await openDB<Schema>(NAME, VERSION, {
      upgrade: (fresh) => {
        fresh.createObjectStore('works', { keyPath: 'id' });
        fresh.createObjectStore('cells');
        fresh.createObjectStore('files', { keyPath: 'sha256' });
      },
      // A page of a newer version waits for this one to let go.
      blocking: (_from, _to, event) => {
        (event.target as IDBDatabase).close();
        onLost();
      },
      terminated: onLost,
    });
    return new Shelf(database);
  }

  /** The latest first. */
  async works(): Promise<KeptWork[]> {
    const works = await this.#database.getAll('works');
    return works.sort((a, b) => b.savedAt - a.savedAt);
  }

  async work(id: string): Promise<KeptWork | null> {
    return (await this.#database.get('works', id)) ?? null;
  }

  /** By cell key, as in a session file. */
  async cells(id: string): Promise<Record<string, unknown>> {
    const transaction = this.#database.transaction('cells');
    const range = ofWork(id);
    const [keys, values] = await Promise.all([transaction.store.getAllKeys(range), transaction.store.getAll(range)]);
    return Object.fromEntries(keys.map(([, cell], index) => [cell, values[index]]));
  }

  /**
   * All of it or nothing: a page that is killed in between leaves what was there before. Says when that was saved: where it
   * is not what the changes are changes of, somebody else wrote it or the browser cleared it. All is asked for at once,
   * because a page that goes hears no answers.
   */
  async write(work: KeptWork, changes: readonly CellChange[]): Promise<number | null> {
    return this.#writeCells(work, changes, false);
  }

  /** The same with all cells, whatever was there. */
  async writeWhole(work: KeptWork, cells: readonly CellChange[]): Promise<void> {
    await this.#writeCells(work, cells, true);
  }

  async #writeCells(work: KeptWork, changes: readonly CellChange[], anew: boolean): Promise<number | null> {
    const transaction = this.#database.transaction(['works', 'cells'], 'readwrite', { durability: 'relaxed' });
    const [works, cells] = [transaction.objectStore('works'), transaction.objectStore('cells')];
    const before = works.get(work.id);
    await settled(transaction, () => {
      const writes: Promise<unknown>[] = [before, works.put(work)];
      if (anew) writes.push(cells.delete(ofWork(work.id)));
      for (const { key, cell } of changes) {
        const place: [string, string] = [work.id, key];
        writes.push(cell === null ? cells.delete(place) : cells.put(cell, place));
      }
      transaction.commit();
      return writes;
    });
    return (await before)?.savedAt ?? null;
  }

  /** False where the work is not there. */
  async putAside(id: string): Promise<boolean> {
    const transaction = this.#database.transaction('works', 'readwrite');
    const work = await transaction.store.get(id);
    if (work && !work.putAside) await transaction.store.put({ ...work, putAside: true });
    await transaction.done;
    return work !== undefined;
  }

  async delete(id: string): Promise<void> {
    const transaction = this.#database.transaction(['works', 'cells'], 'readwrite');
    await transaction.objectStore('works').delete(id);
    await transaction.objectStore('cells').delete(ofWork(id));
    await transaction.done;
  }

  // --- Files ----------------------------------------------------------------------------------------------------

  /** SHA-256 of each. */
  fileDigests(): Promise<string[]> {
    return this.#database.getAllKeys('files');
  }

  /** Those of them that are here. */
  async files(digests: readonly string[]): Promise<readonly Asset[]> {
    const { store } = this.#database.transaction('files');
    const found = await Promise.all(digests.map((sha256) => store.get(sha256)));
    return found.flatMap((kept) => (kept ? [{ name: kept.name, sha256: kept.sha256, blob: kept.bytes instanceof Blob ? kept.bytes : new Blob([kept.bytes]) }] : []));
  }

  async addFile({ name, sha256, blob }: Asset): Promise<void> {
    const transaction = this.#database.transaction('files', 'readwrite', { durability: 'relaxed' });
    await settled(transaction, () => [transaction.store.put({ name, sha256, bytes: blob })]);
  }

  /** Deletes files that no work names. A work names its files before they are added, so none is taken from under it. */
  async sweep(): Promise<void> {
    const transaction = this.#database.transaction(['works', 'files'], 'readwrite');
    const works = await transaction.objectStore('works').getAll();
    const named = new Set(works.flatMap((work) => work.files.map(({ sha256 }) => sha256)));
    const files = transaction.objectStore('files');
    for (const sha256 of await files.getAllKeys()) if (!named.has(sha256)) await files.delete(sha256);
    await transaction.done;
  }

  close(): void {
    this.#database.close();
  }
}

/** Waits for writes and their transaction; of what is refused the transaction knows why, its requests only that it was. */
async function settled(
  transaction: { readonly done: Promise<void>; readonly error: DOMException | null },
  write: () => readonly Promise<unknown>[],
): Promise<void> {
  try {
    await Promise.all([...write(), transaction.done]);
  } catch (error) {
    throw transaction.error ?? error;
  }
}

/** Everything under a work: an array sorts after every text. */
function ofWork(id: string): IDBKeyRange {
  return IDBKeyRange.bound([id], [id, []]);
}
