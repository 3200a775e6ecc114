import type { Match } from '../engine/protocol';
import { setOutline } from './outlines';
import { withCell, type Command, type Place } from './commands';
import { cellOf, type Outline } from './types';

/**
 * An outline with the pose that gave it, as one unit of undo. Each candidate has an outline of its own, which comes with
 * it when it is chosen.
 */
const alternatives = new WeakMap<Outline, readonly Outline[]>();

/** Without poses the outline is on its own: its pose is found as that of any other. */
export function oneClickOutline(place: Place, outlines: readonly Outline[], match: Match | null, origin: string | null): Command {
  const [outline] = outlines;
  const label = 'outline by one click';
  if (!outline || !match || origin === null) return setOutline(place, label, outline ?? null);
  for (const one of outlines) alternatives.set(one, outlines);
  const { reason, decided } = match;
  const candidates = match.candidates.map(({ pose, unmatched, drawn, residual, deviations }) => ({ pose, unmatched, drawn, residual, deviations }));
  const result = { kind: 'posed', from: 'outline', origin, candidates, chosen: 0, reason, decided } as const;
  return { label, place, apply: (doc) => withCell(doc, place, { outline, result, resultOf: outline }) };
}

/** The choice of a candidate whose outline came with it; null for outlines that somebody drew. */
export function chooseWithOutline(place: Place, outline: Outline | null, chosen: number): Command | null {
  const other = outline && alternatives.get(outline)?.[chosen];
  if (!other) return null;
  return {
    label: 'choose another candidate',
    place,
    apply: (doc) => {
      const { result } = cellOf(doc, place.frameId, place.component);
      if (result?.kind !== 'posed' || !result.candidates[chosen]) return doc;
      return withCell(doc, place, { outline: other, result: { ...result, chosen }, resultOf: other });
    },
  };
}
