import { COMPONENT_NAMES } from '../terms/component';
import type { Doc, FileReference } from './types';

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
