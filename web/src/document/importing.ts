import { onOutline } from './commands';
import type { Command } from './command';
import { assignments, isOfMask, type Proposal } from './proposal';
import type { Doc } from './types';

/** Puts every outline of a proposal where it belongs, as one unit of undo. */
export function importProposal(doc: Doc, proposal: Proposal): Command {
  const placed = assignments(doc, proposal).flatMap(({ item, destination }) => {
    if (destination.kind === 'nowhere') return [];
    const drawn = (proposal.exact && item.exactOutline) || item.outline;
    const outline = proposal.onFrames && isOfMask(item) ? { ...drawn, laidBy: 'mask' as const } : drawn;
    const place = { frameId: destination.frame.id, component: destination.component };
    return [{ place, outline }];
  });
  const label = placed.length === 1 ? 'import an outline' : `import ${placed.length} outlines`;
  return {
    label,
    place: placed[0]?.place ?? null,
    apply: (before) => placed.reduce((now, { place, outline }) => onOutline(label, place, () => outline).apply(now), before),
  };
}
