import { isReadable, type Asset } from '../document/assets';
import { auditOf } from '../document/session/audit';
import { writeSession, type SessionFile } from '../document/session/session';
import { filesOf } from '../document/named_files';
import { PROGRAM } from '../terms/program';
import type { Services } from '../jobs/services';
import { bytesOf } from './incoming';

/** Parts of a file, and the names of files that were to be included and that the page has no copy of. */
interface SavedSession {
  readonly parts: string[];
  readonly without: readonly string[];
}

/** The session: the document, every file it names, included or by digest alone, and what gave each result. */
export async function saveSession({ store, assets }: Pick<Services, 'store' | 'assets'>, includeFiles: boolean): Promise<SavedSession> {
  const { doc, ui } = store;
  const files: SessionFile[] = [];
  for (const { name, sha256 } of filesOf(doc)) {
    const asset = assets.get(sha256);
    files.push({ name: asset?.name ?? name, sha256, bytes: includeFiles && asset ? await bytesStillAt(asset) : null });
  }
  const { frameIndex, component, overlayOpacity } = ui;
  const audit = await auditOf(doc);
  const parts = writeSession({ doc, view: { frameIndex, component, overlayOpacity }, files, audit }, PROGRAM, new Date());
  return { parts, without: includeFiles ? files.filter(({ bytes }) => bytes === null).map(({ name }) => name) : [] };
}

/** Null where they went with the browser's storage, or from the disk. */
async function bytesStillAt({ blob }: Asset): Promise<SessionFile['bytes']> {
  return (await isReadable(blob)) ? bytesOf(blob) : null;
}
