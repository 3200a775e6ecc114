import { isReadable, type Assets } from '../document/assets';
import type { FileReference } from '../document/types';
import type { Shelf } from './shelf';

/** What the storage has of the files that a work names. */
export interface KeptFiles {
  readonly isAll: boolean;
  /** Names of files whose only copy was in the storage, and went with it. */
  readonly gone: readonly string[];
}

/** Adds the bytes of files that are not there yet; a file never changes, it is named by what is in it. */
export async function addFiles(shelf: Shelf, assets: Pick<Assets, 'get'>, files: readonly FileReference[]): Promise<KeptFiles> {
  const there = new Set(await shelf.fileDigests());
  const gone: string[] = [];
  for (const { sha256, name } of files) {
    const asset = assets.get(sha256);
    // A session may name files that nobody has opened yet.
    if (there.has(sha256) || !asset) continue;
    if (await isAdded(shelf, { sha256, name, blob: asset.blob })) there.add(sha256);
    else gone.push(name);
  }
  return { isAll: files.every(({ sha256 }) => there.has(sha256)), gone };
}

/** False where there are no bytes any more to add, which is no reason to leave out the other files. */
async function isAdded(shelf: Shelf, file: Parameters<Shelf['addFile']>[0]): Promise<boolean> {
  try {
    await shelf.addFile(file);
    return true;
  } catch (error) {
    // In what a browser throws for such a file no two are alike.
    if (await isReadable(file.blob)) throw error;
    return false;
  }
}
