import { texts } from '../texts/texts';
import type { Command, Place } from './command';
import { withCell } from './commands';
import { bare } from './hand_poses';
import { type Cell, cellOf, type Doc, type Posed, type Result, type Verdict } from './types';
import type { PoseNumbers } from '../geometry/pose_numbers';

/** What following a film gives to cells that nobody worked on. */

/** How the origin of such results begins; the frames that they were followed from come behind it. */
const FOLLOWED = 'followed from';

/** What became of a frame that was looked for a component. */
export interface Followed {
  readonly place: Place;
  /** Null where it was looked for and is not there. */
  readonly pose: PoseNumbers | null;
  readonly deviations: PoseNumbers | null;
  readonly residual: number | null;
  readonly doubtful: boolean;
  /** A sentence without its full stop. */
  readonly because: string;
  /** The frames that it was followed from. */
  readonly from: string;
}

/** Nobody worked on it, so that following may say what is there. */
export function isFree({ outline, result }: Cell): boolean {
  return outline === null && (result === null || isFollowed(result));
}

/** Whether following said what is there. */
export function isFollowed(result: Result | null): boolean {
  if (result === null) return false;
  return result.kind === 'posed' ? result.from === 'film' : result.origin.startsWith(FOLLOWED);
}

/** Takes what following found: one step back for all of it. What a person did meanwhile stays. */
export function takeFollowed(found: readonly Followed[]): Command {
  return { label: texts.steps.follow, apply: (doc) => found.reduce(withFollowed, doc) };
}

function withFollowed(doc: Doc, one: Followed): Doc {
  const cell = cellOf(doc, one.place.frameId, one.place.component);
  return isFree(cell) ? withCell(doc, one.place, { ...cell, result: resultOf(one), resultOf: null }) : doc;
}

function resultOf({ pose, deviations, residual, doubtful, because, from }: Followed): Result {
  const origin = `${FOLLOWED} ${from}`;
  const sentence = `${because.charAt(0).toUpperCase()}${because.slice(1)}.`;
  if (!pose) return { kind: 'failed', origin, sentence };
  const verdict: Verdict = { word: doubtful ? 'doubtful' : 'good', because };
  const candidates = [{ ...bare(pose), residual, deviations }];
  return { kind: 'posed', from: 'film', origin, candidates, chosen: 0, reason: sentence, decided: true, verdict } satisfies Posed;
}
