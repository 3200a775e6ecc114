import type { Command, Place } from './command';
import { cellKey, cellOf, chosenCandidate, type Doc } from './types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import { COMPONENT_NAMES } from '../terms/component';
import { texts } from '../texts/texts';

/** The set of poses to compare with: those of a file that was opened, or what was on view when somebody kept them. */

/** Keeps every pose on view as the set to compare with. */
export function keepReference(name: string): Command {
  return { label: texts.steps.keepReference, apply: (doc) => ({ ...doc, reference: { name, poses: chosenPoses(doc) } }) };
}

export function forgetReference(): Command {
  return { label: texts.steps.forgetReference, apply: (doc) => ({ ...doc, reference: null }) };
}

/** Poses of a file become the set to compare with; what it says nothing of stays as it was, and its name too. */
export function withReference(doc: Doc, name: string, poses: Readonly<Record<string, PoseNumbers>>): Doc {
  const names = doc.reference?.name.split(', ') ?? [];
  const joined = names.includes(name) ? names : [...names, name];
  return { ...doc, reference: { name: joined.join(', '), poses: { ...doc.reference?.poses, ...poses } } };
}

export function referencePose(doc: Doc, place: Place | null): PoseNumbers | null {
  return (place && doc.reference?.poses[cellKey(place.frameId, place.component)]) ?? null;
}

function chosenPoses(doc: Doc): Record<string, PoseNumbers> {
  const entries = doc.frames.flatMap(({ id }) =>
    COMPONENT_NAMES.flatMap((component) => {
      const candidate = chosenCandidate(cellOf(doc, id, component));
      return candidate ? [[cellKey(id, component), candidate.pose] as const] : [];
    }),
  );
  return Object.fromEntries(entries);
}
