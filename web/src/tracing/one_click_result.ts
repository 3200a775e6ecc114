import type { Match } from '../workers/protocol/match';
import type { OneClickFacts } from '../workers/protocol/one_click';
import { withCell } from '../document/commands';
import type { Command, Place } from '../document/command';
import { setOutline } from '../document/outlines';
import { setItsOutline } from '../document/own_outlines';
import { cellOf, type OnFrame, type Outline, type Result } from '../document/types';
import { PROGRAM } from '../terms/program';
import { texts } from '../texts/texts';

/** What came of a click, and by which film. */
export type Answer = Pick<OneClickFacts, 'match' | 'sentence' | 'supports'> & { readonly onFrame: OnFrame };

/**
 * Outlines with the poses that gave them, the chosen first, as one unit of undo. Without poses the outline is on its
 * own: its pose is found as that of any other. Where nothing fits there is no pose: `sentence` says why and what to do, and
 * the outline can be corrected.
 */
export function oneClickOutline(place: Place, outlines: readonly Outline[], answer: Answer, origin: string | null): Command {
  const { match, sentence } = answer;
  const [outline] = outlines;
  const label = texts.steps.oneClick;
  if (!outline || !match || origin === null) return setOutline(place, label, outline ?? null);
  const result = match.refusal === null ? posed(outlines, match, answer, origin) : ({ kind: 'failed', origin, sentence } as const);
  return { label, place, apply: (doc) => withCell(doc, place, { ...cellOf(doc, place.frameId, place.component), outline, result, resultOf: outline }) };
}

function posed(outlines: readonly Outline[], match: Match, { supports, onFrame }: Answer, origin: string): Result {
  const candidates = match.candidates.map(({ pose, unmatched, drawn, residual, deviations, judged }, index) => {
    const support = supports[index];
    const candidate = { pose, unmatched, drawn, residual, deviations, judged, ...(support !== undefined && { support }) };
    const own = outlines[index];
    if (own) setItsOutline(candidate, own);
    return candidate;
  });
  const { reason, decided, verdict } = match;
  return { kind: 'posed', from: 'outline', origin, candidates, chosen: 0, reason, decided, verdict, program: PROGRAM, onFrame };
}
