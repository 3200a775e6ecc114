import { signedAxes, tiltAxes } from '../document/axes';
import type { Place } from '../document/command';
import { indexOfFrame } from '../document/frame_index';
import { foundBefore } from '../document/hand_poses';
import { checkState, markOf } from '../document/marks';
import { cellOf, chosenCandidate, type Doc, isByHand, verdictAlone } from '../document/types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { otherThan, type ComponentName } from '../terms/component';
import type { AroundHand } from '../workers/protocol/by_hand';
import type { Counterpart, Surroundings } from '../workers/protocol/match';
import type { OtherInFrame } from '../workers/protocol/one_click';

/**
 * What a choice in a frame may rest on: poses that were decided themselves, chosen by hand, set by hand, or read from a
 * file. What is called doubtful speaks for nothing else, unless a person has checked it.
 */
export function surroundingsOf(doc: Doc, frameId: string, component: ComponentName): Surroundings {
  const index = indexOfFrame(doc, frameId);
  const neighbours = [index - 1, index + 1].map((frame) => reliablePose(doc, frame, component));
  return { counterpart: counterpartOf(doc, index, component), neighbours: neighbours.filter((pose) => pose !== null) };
}

/** What a pose that somebody set is held against: the same, and what had been found there. */
export function aroundHand(doc: Doc, { frameId, component }: Place): AroundHand {
  return { ...surroundingsOf(doc, frameId, component), rivals: foundBefore(cellOf(doc, frameId, component).result) };
}

/** Where the joint's other component is, for who asks where its joint leaves this one. */
export function otherInFrame(doc: Doc, frameId: string, component: ComponentName): OtherInFrame | null {
  const other = otherThan(component);
  const pose = reliablePose(doc, indexOfFrame(doc, frameId), other);
  const [axes, own] = [other, component].map((name) => signedAxes(doc.components[name as ComponentName]));
  return pose && axes && own ? { pose, axes, own } : null;
}

function counterpartOf(doc: Doc, frame: number, component: ComponentName): Counterpart | null {
  const other = otherThan(component);
  const pose = reliablePose(doc, frame, other);
  const [axes, own] = [other, component].map((name) => tiltAxes(doc.components[name as ComponentName]));
  return pose && axes && own ? { pose, axes, own } : null;
}

function reliablePose(doc: Doc, index: number, component: ComponentName): PoseNumbers | null {
  const frameId = doc.frames[index]?.id;
  const cell = cellOf(doc, frameId, component);
  const { result, resultOf, outline } = cell;
  const candidate = chosenCandidate(cell);
  if (frameId === undefined || result?.kind !== 'posed' || !candidate) return null;
  const checked = checkState(cell, markOf(doc, { frameId, component })) === 'yes';
  if (verdictAlone(result)?.word === 'doubtful' && !checked) return null;
  if (isByHand(result)) return candidate.pose;
  if (resultOf !== outline) return null;
  if (result.from === 'file' || result.chosen !== 0) return candidate.pose;
  return (result.decided || checked) && candidate.residual !== null ? candidate.pose : null;
}
