import { auditOf } from '../document/session/audit';
import { writeSession, type SessionFile } from '../document/session/session';
import { filesOf } from '../document/named_files';
import { PROGRAM } from '../terms/program';
import type { Services } from '../jobs/services';
import { bytesOf } from './incoming';

/**
 * The session as parts of a file: the document, every file it names, included or by digest alone, and what gave each
 * result.
 */
export async function saveSession({ store, assets }: Services, includeFiles: boolean): Promise<string[]> {
  const { doc, ui } = store;
  const files: SessionFile[] = [];
  for (const { name, sha256 } of filesOf(doc)) {
    const asset = assets.get(sha256);
    files.push({ name: asset?.name ?? name, sha256, bytes: includeFiles && asset ? await bytesOf(asset.blob) : null });
  }
  const { frameIndex, component, overlayOpacity } = ui;
  const audit = await auditOf(doc);
  return writeSession({ doc, view: { frameIndex, component, overlayOpacity }, files, audit }, PROGRAM, new Date());
}
