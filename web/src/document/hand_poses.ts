import { withCell } from './commands';
import type { Command, Place } from './command';
import { type Candidate, cellOf, type Doc, isByHand, type OnFrame, type Posed, type Result, type Verdict } from './types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { texts } from '../texts/texts';

/** Poses that somebody set by hand. */

/** How a pose set by hand was begun, or what was done to it since: the origin that its result keeps. */
export type HandOrigin = 'set by hand' | 'refined from a pose set by hand';

/** What refinement found from a pose set by hand. */
export interface HandFit {
  readonly candidate: Candidate;
  /** A sentence: against what it was refined, and what was held. */
  readonly reason: string;
  readonly verdict: Verdict;
  /** Null against an outline. */
  readonly onFrame: OnFrame | null;
}

/** Sets a pose by hand. Nudges with the same `mergeKey` are one step back. */
export function setPoseByHand(place: Place, pose: PoseNumbers, label = texts.steps.adjustPose, mergeKey?: string): Command {
  return {
    label,
    place,
    ...(mergeKey === undefined ? {} : { mergeKey }),
    apply: (doc) => withResult(doc, place, byHand('set by hand', bare(pose), null, null)),
  };
}

/** Takes over what refinement made of a pose set by hand. */
export function takeHandFit(place: Place, { candidate, reason, verdict, onFrame }: HandFit): Command {
  return {
    label: texts.steps.refineFromHand,
    place,
    apply: (doc) => {
      const posed = byHand('refined from a pose set by hand', candidate, reason, verdict);
      return withResult(doc, place, onFrame ? { ...posed, onFrame } : posed);
    },
  };
}

/**
 * What the cell's outline, or the frame without one, says of a pose set by hand or brought in a file; null where nothing can be held against it.
 * The page works it out by itself: no unit of undo.
 */
export function withHandVerdict(doc: Doc, place: Place, of: Posed, verdict: Verdict | null): Doc {
  const cell = cellOf(doc, place.frameId, place.component);
  if (cell.result !== of) return doc;
  return withCell(doc, place, { ...cell, result: { ...of, verdict }, resultOf: cell.outline });
}

/** Gives the cell back to its outline: the page finds its pose anew. */
export function dropHandPose(place: Place): Command {
  return {
    label: texts.steps.dropHandPose,
    place,
    apply: (doc) => {
      const cell = cellOf(doc, place.frameId, place.component);
      return isByHand(cell.result) ? withCell(doc, place, { ...cell, result: null, resultOf: null }) : doc;
    },
  };
}

/** Offers one more pose of an outline, and chooses it. The same view twice is one candidate. */
export function offerCandidate(place: Place, candidate: Candidate): Command {
  return {
    label: texts.steps.takeView,
    place,
    apply: (doc) => {
      const cell = cellOf(doc, place.frameId, place.component);
      if (cell.result?.kind !== 'posed' || cell.result.from !== 'outline') return doc;
      const candidates = [...cell.result.candidates.filter((other) => !isPicked(cell.result as Posed, other)), candidate];
      const result = { ...cell.result, candidates, chosen: candidates.length - 1 };
      return withCell(doc, place, { ...cell, result });
    },
  };
}

/** Was this candidate taken from the landscape? The model has been drawn at the others, not at this one. */
export function isPicked(result: Posed, candidate: Candidate): boolean {
  const drawn = result.candidates.some((other) => other.residual !== null || other.drawn !== null);
  return result.from === 'outline' && drawn && candidate.residual === null && candidate.drawn === null;
}

// --- Parts ----------------------------------------------------------------------------------------------------------

/** A pose of which nothing else is known. */
export function bare(pose: PoseNumbers): Candidate {
  return { pose, unmatched: null, drawn: null, residual: null, deviations: null, judged: null };
}

function byHand(origin: HandOrigin, candidate: Candidate, reason: string | null, verdict: Verdict | null): Posed {
  return { kind: 'posed', from: 'hand', origin, candidates: [candidate], chosen: 0, reason, decided: true, verdict };
}

function withResult(doc: Doc, place: Place, result: Posed): Doc {
  const cell = cellOf(doc, place.frameId, place.component);
  const rivals = foundBefore(cell.result);
  return withCell(doc, place, { ...cell, result: rivals.length > 0 ? { ...result, rivals } : result, resultOf: cell.outline });
}

/** Poses that the program found in a cell, also where a hand has set another since. */
export function foundBefore(result: Result | null): readonly PoseNumbers[] {
  if (result?.kind !== 'posed' || result.from === 'file') return [];
  return isByHand(result) ? (result.rivals ?? []) : result.candidates.map(({ pose }) => pose);
}
