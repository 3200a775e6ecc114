import { writeSession, type SessionFile } from '../document/session';
import { COMPONENT_NAMES, type Doc, type FileReference } from '../document/types';
import type { Services } from './services';

export const PROGRAM = `fluoropose ${__VERSION__}`;

/** The session as parts of a file: the document, and every file it names, included or by digest alone. */
export function saveSession({ store, assets }: Services, includeFiles: boolean): string[] {
  const { doc, ui } = store;
  const files = filesOf(doc).map(({ name, sha256 }): SessionFile => {
    const asset = assets.get(sha256);
    return { name: asset?.name ?? name, sha256, bytes: includeFiles ? (asset?.bytes ?? null) : null };
  });
  const { frameIndex, component, overlayOpacity } = ui;
  return writeSession({ doc, view: { frameIndex, component, overlayOpacity }, files }, PROGRAM, new Date());
}

function filesOf(doc: Doc): FileReference[] {
  const references = new Map<string, FileReference>();
  for (const { source: sha256, name } of doc.frames) references.set(sha256, { sha256, name });
  for (const component of COMPONENT_NAMES) {
    const { model, libraryFile } = doc.components[component];
    for (const reference of [model, libraryFile]) if (reference) references.set(reference.sha256, reference);
  }
  return [...references.values()];
}
