import { type Cell, cellOf, chosenCandidate, type Doc, isByHand } from '../document/types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { ComponentName } from '../terms/component';
import type { Surroundings } from '../workers/protocol/match';

/** What a choice in a frame may rest on: poses that were decided themselves, chosen by hand or read from a file. */
export function surroundingsOf(doc: Doc, frameId: string, component: ComponentName): Surroundings {
  const index = doc.frames.findIndex((frame) => frame.id === frameId);
  const reliable = (frame: number, name: ComponentName) => reliablePose(cellOf(doc, doc.frames[frame]?.id, name));
  const neighbours = [index - 1, index + 1].map((frame) => reliable(frame, component));
  return {
    counterpart: reliable(index, component === 'femur' ? 'tibia' : 'femur'),
    neighbours: neighbours.filter((pose) => pose !== null),
  };
}

function reliablePose(cell: Cell): PoseNumbers | null {
  const { result, resultOf, outline } = cell;
  const candidate = chosenCandidate(cell);
  if (candidate && isByHand(result)) return candidate.pose;
  if (result?.kind !== 'posed' || !candidate || resultOf !== outline) return null;
  if (result.from === 'file' || result.chosen !== 0) return candidate.pose;
  return result.decided && candidate.residual !== null ? candidate.pose : null;
}
