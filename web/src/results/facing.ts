import { knownAxes } from '../document/axes';
import { cellOf, chosenCandidate, type Doc, verdictAlone } from '../document/types';
import { applied, rotationOf, type Vector } from '../geometry/pose_motion';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { otherThan, type ComponentName } from '../terms/component';

/** What the film says of a front that a shape does not tell, and in how many frames. */
export interface Facing {
  readonly front: 'as shown' | 'the other way';
  readonly frames: number;
}

/** A knee never turns so far that right and left change places: cosine between the two components' directions to the right. */
const SAME_WAY = 0.5;

/** Both components of a knee face one way. Null where no frame has both, doubtful ones aside, or frames disagree. */
export function facingByFilm(doc: Doc, component: ComponentName): Facing | null {
  const { axes } = doc.components[component];
  const other = otherThan(component);
  const known = knownAxes(doc.components[other]);
  if (axes?.told !== 'not the front' || !known) return null;
  const cosines = doc.frames.flatMap(({ id }) => {
    const [own, counterpart] = [surePose(doc, id, component), surePose(doc, id, other)];
    return own && counterpart ? [dot(rightOf(own, axes.directions[2]), rightOf(counterpart, known[2]))] : [];
  });
  const frames = cosines.length;
  if (frames === 0) return null;
  if (cosines.every((cosine) => cosine > SAME_WAY)) return { front: 'as shown', frames };
  return cosines.every((cosine) => cosine < -SAME_WAY) ? { front: 'the other way', frames } : null;
}

function surePose(doc: Doc, frameId: string, component: ComponentName): PoseNumbers | null {
  const cell = cellOf(doc, frameId, component);
  return verdictAlone(cell.result)?.word === 'doubtful' ? null : (chosenCandidate(cell)?.pose ?? null);
}

function rightOf(pose: PoseNumbers, right: Vector): Vector {
  return applied(rotationOf(pose), right);
}

function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
