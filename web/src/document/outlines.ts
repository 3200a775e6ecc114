import { transformed, type Similarity } from '../geometry/similarity';
import type { FramePoint } from '../geometry/points';
import { onOutline } from './commands';
import type { Command, Place } from './command';
import { byHand } from './laid_by';
import { carriedSides } from './sides';
import { markedStretch, type Stretch } from './stretch';
import { cellOf, type Doc, type Outline } from './types';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';

/** Commands that change an outline as a whole. */

export function transformOutline(place: Place, label: string, similarity: Similarity): Command {
  return onOutline(label, place, (outline) => outline && { ...outline, ...byHand(outline), points: transformed(similarity, outline.points) });
}

/** The same by keys: one press after the other is one unit of undo. */
export function nudgeOutline(place: Place, similarity: Similarity): Command {
  const command = transformOutline(place, texts.steps.moveOutline, similarity);
  return { ...command, mergeKey: `nudge ${place.frameId} ${place.component}` };
}

/** Takes the place of whatever outline there is. */
export function setOutline(place: Place, label: string, outline: Outline | null): Command {
  return onOutline(label, place, () => outline);
}

/** A new course of the outline on view: what was marked unknown stays so where the new sides run along it. */
export function reshapeOutline(place: Place, label: string, points: readonly FramePoint[]): Command {
  return onOutline(label, place, (outline) => ({
    points,
    closed: true,
    unknownSides: outline ? carriedSides(outline, points) : [],
    ...byHand(outline),
  }));
}

export function markStretch(place: Place, stretch: Stretch, unknown: boolean): Command {
  const label = unknown ? texts.steps.stretchUnknown : texts.steps.stretchKnown;
  return onOutline(label, place, (outline) => (outline?.closed ? markedStretch(outline, stretch, unknown) : outline));
}

export function markAllKnown(place: Place): Command {
  return onOutline(texts.steps.allKnown, place, (outline) =>
    outline && outline.unknownSides.length > 0 ? { ...outline, unknownSides: [] } : outline,
  );
}

/** A stretch of a draft, as one unit of undo. */
export function addPoints(place: Place, label: string, points: readonly FramePoint[], closed: boolean, laid: (before: Outline | null) => Pick<Outline, 'laidBy'>): Command {
  return onOutline(label, place, (outline) => ({
    points: [...(outline?.points ?? []), ...points],
    closed,
    unknownSides: outline?.unknownSides ?? [],
    ...laid(outline),
  }));
}

/** The nearest earlier (-1) or later (+1) frame with a closed outline of the component. */
export function tracedNeighbour(doc: Doc, frameIndex: number, component: ComponentName, step: -1 | 1): number | null {
  for (let index = frameIndex + step; index >= 0 && index < doc.frames.length; index += step) {
    if (cellOf(doc, doc.frames[index]?.id, component).outline?.closed) return index;
  }
  return null;
}

export function copyOutline(place: Place, outline: Outline, from: string): Command {
  return setOutline(place, `copy the outline of ${from}`, { ...outline, ...byHand(outline) });
}
