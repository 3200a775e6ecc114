import type { Match } from '../workers/protocol/match';
import { withCell } from '../document/commands';
import type { Command, Place } from '../document/command';
import { setOutline } from '../document/outlines';
import { setItsOutline } from '../document/own_outlines';
import { cellOf, type Outline } from '../document/types';
import { texts } from '../texts/texts';

/**
 * Outlines with the poses that gave them, the chosen first, as one unit of undo. Without poses the outline is on its
 * own: its pose is found as that of any other.
 */
export function oneClickOutline(place: Place, outlines: readonly Outline[], match: Match | null, origin: string | null): Command {
  const [outline] = outlines;
  const label = texts.steps.oneClick;
  if (!outline || !match || origin === null) return setOutline(place, label, outline ?? null);
  const candidates = match.candidates.map(({ pose, unmatched, drawn, residual, deviations, judged }, index) => {
    const candidate = { pose, unmatched, drawn, residual, deviations, judged };
    const own = outlines[index];
    if (own) setItsOutline(candidate, own);
    return candidate;
  });
  const { reason, decided } = match;
  const result = { kind: 'posed', from: 'outline', origin, candidates, chosen: 0, reason, decided, verdict: null } as const;
  return { label, place, apply: (doc) => withCell(doc, place, { ...cellOf(doc, place.frameId, place.component), outline, result, resultOf: outline }) };
}
