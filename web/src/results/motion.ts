import { progressOf } from './progress';
import { knownAxes } from '../document/axes';
import { NO_MARK } from '../document/marks';
import { cellOf, chosenCandidate, type Doc } from '../document/types';
import type { Directions } from '../geometry/axes';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';

/** The six numbers of a joint, as the core gives them: mm, then degrees. */
export interface Motion {
  readonly anterior: number;
  readonly superior: number;
  readonly lateral: number;
  readonly flexion: number;
  readonly abduction: number;
  readonly internal: number;
}

export const QUANTITIES = ['flexion', 'abduction', 'internal', 'anterior', 'superior', 'lateral'] as const satisfies readonly (keyof Motion)[];
export type Quantity = (typeof QUANTITIES)[number];

/** A frame in which both components have a pose. */
export interface JointPoint {
  /** Of the frame, from 0. */
  readonly index: number;
  readonly motion: Motion;
  /** Neither pose is doubtful. */
  readonly sure: boolean;
}

/** A component's pose, and the anatomical axes of its model. */
export interface PlacedInJoint {
  readonly pose: PoseNumbers;
  readonly axes: Directions;
}

type MotionOf = (femur: PlacedInJoint, tibia: PlacedInJoint, side: 'left' | 'right') => Motion;

/** What is missing for the joint's motion: signs depend on the side of the body, everything on the axes of the models. */
export type MotionNeeds = { readonly what: 'side' | 'poses'; readonly component?: undefined } | { readonly what: 'front' | 'axes'; readonly component: ComponentName };

export function motionNeeds(doc: Doc): MotionNeeds {
  for (const component of COMPONENT_NAMES) {
    const { axes } = doc.components[component];
    if (axes?.told === 'not the front') return { what: 'front', component };
    if (axes && axes.told !== 'all') return { what: 'axes', component };
  }
  return { what: doc.side === 'unknown' ? 'side' : 'poses' };
}

/** Empty while the side of the body or the axes of a model are not known. */
export function jointMotion(doc: Doc, motionOf: MotionOf): readonly JointPoint[] {
  const { side } = doc;
  const [femurAxes, tibiaAxes] = [knownAxes(doc.components.femur), knownAxes(doc.components.tibia)];
  if (side === 'unknown' || !femurAxes || !tibiaAxes) return [];
  return doc.frames.flatMap((frame, index) => {
    const [femur, tibia] = (['femur', 'tibia'] as const).map((component) => cellOf(doc, frame.id, component));
    const [a, b] = [femur && chosenCandidate(femur), tibia && chosenCandidate(tibia)];
    if (!a || !b) return [];
    return [{ index, motion: motionOf({ pose: a.pose, axes: femurAxes }, { pose: b.pose, axes: tibiaAxes }, side), sure: isSure(doc, frame.id, 'femur') && isSure(doc, frame.id, 'tibia') }];
  });
}

function isSure(doc: Doc, frameId: string, component: ComponentName): boolean {
  return !progressOf(cellOf(doc, frameId, component), NO_MARK, null).doubtful;
}

/** Points in runs of frames that follow each other: a line is drawn through a run, none across a gap. */
export function runsOf(points: readonly JointPoint[]): readonly (readonly JointPoint[])[] {
  const runs: JointPoint[][] = [];
  for (const point of points) {
    const run = runs.at(-1);
    if (run && run.at(-1)!.index === point.index - 1) run.push(point);
    else runs.push([point]);
  }
  return runs;
}
