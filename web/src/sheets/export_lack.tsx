import type { ComponentChildren } from 'preact';
import { outlinesOf } from '../commands/exporting';
import type { State } from '../document/store';
import { cellOf, chosenCandidate } from '../document/types';
import { posesOf } from '../exchange/pose_rows';
import type { JointNumbers } from '../results/joint_curves';
import { motionNeeds } from '../results/motion';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import type { FilmType } from '../workers/protocol/overlay';
import { isOfBoth } from '../terms/exporting';
import { Needs } from '../steps/joint/needs';

/** Why there is nothing to write yet, and what to do; null where there is. `film`: what kind this browser writes. */
export function lackOf(state: State, numbers: JointNumbers, film: FilmType | null | undefined): ComponentChildren | null {
  const doc = state.history.present;
  const { kind, forms } = state.ui.exporting;
  const words = later.exporting;
  if (doc.frames.length === 0) return words.nothing.frames;
  switch (kind) {
    case 'session':
      return null;
    case 'outlines':
      return outlinesOf(doc).length > 0 ? null : words.nothing.outlines;
    case 'poses':
      return posesLack(state);
    case 'film':
      if (forms.film === 'video' && film === null) return words.film.unable;
      return forms.film === 'video' && film === undefined ? words.making : waitingFor(numbers);
    default: {
      const needs = motionNeeds(doc);
      if (needs) return <Needs needs={needs} />;
      if (kind === 'joint' && forms.joint === 'mot' && doc.rate === null) return words.nothing.times;
      return waitingFor(numbers) ?? (numbers.of.size === 0 ? words.making : null);
    }
  }
}

/** Numbers that are still being worked out would be missing in a file. */
function waitingFor({ waiting }: JointNumbers): string | null {
  return waiting > 0 ? later.exporting.faults.waiting(waiting) : null;
}

function posesLack({ ui, history }: State): string | null {
  const doc = history.present;
  const { forms, component } = ui.exporting;
  const { nothing } = later.exporting;
  const named = texts.component[component];
  if (forms.poses === 'jtap') return chosenCandidate(cellOf(doc, doc.frames[ui.frameIndex]?.id, component)) ? null : nothing.pose(named);
  const some = (one: typeof component) => posesOf(doc, one).some((pose) => pose !== null);
  return (isOfBoth(forms.poses) ? some('femur') || some('tibia') : some(component)) ? null : nothing.poses(named);
}
