import { COMPONENT_NAMES } from '../terms/component';
import { withCell } from './commands';
import { cellOf, type Doc, type Posed } from './types';

/** What the joint tells of poses, frame by frame; null takes back what was told. The same object where nothing changes. */
export function withAsides(doc: Doc, told: readonly (string | null)[]): Doc {
  return doc.frames.reduce((changed, { id: frameId }, index) => COMPONENT_NAMES.reduce((changed, component) => {
    const cell = cellOf(changed, frameId, component);
    const { result } = cell;
    const aside = told[index] ?? null;
    if (result?.kind !== 'posed' || (result.aside ?? null) === aside) return changed;
    return withCell(changed, { frameId, component }, { ...cell, result: withAside(result, aside) });
  }, changed), doc);
}

function withAside(result: Posed, aside: string | null): Posed {
  if (aside !== null) return { ...result, aside };
  const { aside: _, ...rest } = result;
  return rest;
}
