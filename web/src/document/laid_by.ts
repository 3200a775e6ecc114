import type { Cell, Outline } from './types';

/** Who laid an outline on the frame, as points come: it decides how its pose is found. */

type Laid = Pick<Outline, 'laidBy'>;

/** What a hand makes of an outline that a tool laid, in whole or in part. */
export function byHand(before: Outline | null): Laid {
  return before?.laidBy ? { laidBy: 'mixed' } : {};
}

/** What a tool makes of a draft that it goes on with: one point has no side yet. */
export function byTool(before: Outline | null): Laid {
  return { laidBy: !before || before.points.length < 2 || before.laidBy === 'tool' ? 'tool' : 'mixed' };
}

/** Of another course of the same outline. */
export function asBefore({ laidBy }: Outline): Laid {
  return laidBy ? { laidBy } : {};
}

/** Lies the outline where tools see edges, in whole or in part, and not where a person saw the implant? */
export function isOnEdges(outline: Outline | null): boolean {
  return outline?.laidBy !== undefined;
}

/** Does the pose rest on the frame by now, as its film puts the edges? Then the model's silhouette is the outline that counts. */
export function isSurpassed({ outline, result, resultOf }: Cell): boolean {
  const isCorrected = result?.kind === 'posed' && result.from === 'outline' && result.onFrame?.film != null;
  return isCorrected && resultOf === outline && isOnEdges(outline) && !isSilhouette(outline);
}

/** Is the outline itself a result, the model's silhouette, that goes along with its pose? */
export function isSilhouette(outline: Outline | null): boolean {
  return outline?.laidBy === 'click';
}

/** Is it where a click led, and no pose is there? It is kept to be given to the other component or corrected, and is no finding to look at. */
export function isDiscarded({ outline, result, resultOf }: Cell): boolean {
  return isSilhouette(outline) && result?.kind === 'failed' && resultOf === outline;
}
