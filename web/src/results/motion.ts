import { isAssumed, knownAxes } from '../document/axes';
import { indexOfFrame } from '../document/frame_index';
import type { Place } from '../document/command';
import { checkState, markOf, NO_MARK } from '../document/marks';
import { type Candidate, type Cell, cellOf, chosenCandidate, type Doc, verdictOf } from '../document/types';
import type { Directions } from '../geometry/axes';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { texts } from '../texts/texts';
import { progressOf } from './progress';

/** The six numbers of a joint by the field's convention, as the core gives them: mm, then degrees. */
export interface Motion {
  readonly anterior: number;
  readonly superior: number;
  readonly lateral: number;
  readonly flexion: number;
  readonly abduction: number;
  readonly internal: number;
}

/** A component's pose, and the anatomical axes of its model. */
export interface PlacedInJoint {
  readonly pose: PoseNumbers;
  readonly axes: Directions;
}

/** What is missing for the joint's motion: signs depend on the side of the body, everything on the axes of the models. */
export type MotionNeeds = { readonly what: 'side' | 'poses' } | { readonly what: 'front' | 'axes' | 'finding'; readonly component: ComponentName };

/** Null where nothing is missing. */
export function motionNeeds(doc: Doc): MotionNeeds | null {
  for (const component of COMPONENT_NAMES) {
    const { axes } = doc.components[component];
    if (axes?.told === 'not the front') return { what: 'front', component };
    if (axes && axes.told !== 'all') return { what: 'axes', component };
    if (!axes && !isAssumed(doc.components[component])) return { what: 'finding', component };
  }
  if (doc.side === 'unknown') return { what: 'side' };
  return jointAsked(doc)?.frames.length === 0 ? { what: 'poses' } : null;
}

/** A frame in which both components have a pose. */
export interface JointFrame {
  readonly id: string;
  /** From 0. */
  readonly index: number;
  readonly femur: Candidate;
  readonly tibia: Candidate;
}

/** All that the numbers of a joint rest on. */
export interface JointAsked {
  readonly side: 'left' | 'right';
  readonly axes: Readonly<Record<ComponentName, Directions>>;
  /** SHA-256; null where there is no model. */
  readonly models: Readonly<Record<ComponentName, string | null>>;
  readonly frames: readonly JointFrame[];
}

/** What is asked of one frame of it; null where a pose is missing. */
export function jointAskedIn(doc: Doc, frameId: string): JointAsked | null {
  const frames = jointFrame(doc, frameId, indexOfFrame(doc, frameId));
  const joint = jointOf(doc);
  return joint && frames.length > 0 ? { ...joint, frames } : null;
}

const asked = new WeakMap<Doc, JointAsked>();

/** Null while the side of the body or the axes of a model are not known. */
export function jointAsked(doc: Doc): JointAsked | null {
  const known = asked.get(doc);
  if (known) return known;
  const joint = jointOf(doc);
  if (!joint) return null;
  const found = { ...joint, frames: doc.frames.flatMap(({ id }, index) => jointFrame(doc, id, index)) };
  asked.set(doc, found);
  return found;
}

function jointOf({ side, components }: Doc): Omit<JointAsked, 'frames'> | null {
  const [femur, tibia] = [knownAxes(components.femur), knownAxes(components.tibia)];
  if (side === 'unknown' || !femur || !tibia) return null;
  const models = { femur: components.femur.model?.sha256 ?? null, tibia: components.tibia.model?.sha256 ?? null };
  return { side, axes: { femur, tibia }, models };
}

/** None where a pose is missing. */
function jointFrame(doc: Doc, id: string, index: number): readonly JointFrame[] {
  const [femur, tibia] = (['femur', 'tibia'] as const).map((component) => chosenCandidate(cellOf(doc, id, component)));
  return femur && tibia ? [{ id, index, femur, tibia }] : [];
}

/** How far the numbers of a frame are to be trusted: as far as the poorer of its two poses. */
export interface JointTrust {
  /** Nobody has accepted it as it is. */
  readonly doubtful: boolean;
  /** Both poses, or whatever of them is doubtful. */
  readonly checked: boolean;
}

const trusts = new WeakMap<Doc, readonly JointTrust[]>();

/** Of all frames, by their index. */
export function jointTrusts(doc: Doc): readonly JointTrust[] {
  const known = trusts.get(doc) ?? doc.frames.map(({ id }) => trustOf(doc, id));
  trusts.set(doc, known);
  return known;
}

/** Of one frame, by its id. */
export function trustOf(doc: Doc, frameId: string): JointTrust {
  const checks = COMPONENT_NAMES.map((component) => checkOf(doc, { frameId, component }));
  const doubtful = checks.some(({ isDoubtful, isChecked }) => isDoubtful && !isChecked);
  const isAccepted = !doubtful && checks.some(({ isDoubtful }) => isDoubtful);
  return { doubtful, checked: isAccepted || checks.every(({ isChecked }) => isChecked) };
}

/** Whose poses are doubtful in a frame, and nobody has accepted. */
export function doubtfulIn(doc: Doc, frameId: string): readonly ComponentName[] {
  return COMPONENT_NAMES.filter((component) => {
    const { isDoubtful, isChecked } = checkOf(doc, { frameId, component });
    return isDoubtful && !isChecked;
  });
}

function checkOf(doc: Doc, place: Place): { readonly isDoubtful: boolean; readonly isChecked: boolean } {
  const cell = cellOf(doc, place.frameId, place.component);
  return { isDoubtful: doubtOf(cell) !== null, isChecked: checkState(cell, markOf(doc, place)) === 'yes' };
}

/** Why a pose is doubtful, a sentence without its full stop; null where it is not. */
export function doubtOf(cell: Cell): string | null {
  if (!progressOf(cell, NO_MARK, null).doubtful) return null;
  return verdictOf(cell.result)?.because ?? texts.joint.undecided;
}

/** What stands in frames that follow each other: a line is drawn through a run, none across a gap, or where two are not `joined`. */
export function runsOf<T extends { readonly index: number }>(points: readonly T[], joined: (a: T, b: T) => boolean = () => true): readonly (readonly T[])[] {
  const runs: T[][] = [];
  for (const point of points) {
    const run = runs.at(-1);
    const last = run?.at(-1);
    if (run && last && last.index === point.index - 1 && joined(last, point)) run.push(point);
    else runs.push([point]);
  }
  return runs;
}
