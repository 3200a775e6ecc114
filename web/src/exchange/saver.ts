import { auditOf } from '../document/session/audit';
import { writeSession, type SessionFile } from '../document/session/session';
import type { Doc, FileReference } from '../document/types';
import { COMPONENT_NAMES } from '../terms/component';
import { PROGRAM } from '../terms/program';
import type { Services } from '../jobs/services';

/**
 * The session as parts of a file: the document, every file it names, included or by digest alone, and what gave each
 * result.
 */
export async function saveSession({ store, assets }: Services, includeFiles: boolean): Promise<string[]> {
  const { doc, ui } = store;
  const files = filesOf(doc).map(({ name, sha256 }): SessionFile => {
    const asset = assets.get(sha256);
    return { name: asset?.name ?? name, sha256, bytes: includeFiles ? (asset?.bytes ?? null) : null };
  });
  const { frameIndex, component, overlayOpacity } = ui;
  const audit = await auditOf(doc);
  return writeSession({ doc, view: { frameIndex, component, overlayOpacity }, files, audit }, PROGRAM, new Date());
}

/** Every file that a document names, once. */
export function filesOf(doc: Doc): FileReference[] {
  const references = new Map<string, FileReference>();
  for (const { source: sha256, name } of doc.frames) references.set(sha256, { sha256, name: name.replace(/ #\d+$/, '') });
  for (const component of COMPONENT_NAMES) {
    const { model, libraryFile } = doc.components[component];
    for (const reference of [model, libraryFile]) if (reference) references.set(reference.sha256, reference);
  }
  return [...references.values()];
}
