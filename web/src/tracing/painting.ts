import type { Command, Place } from '../document/command';
import { byHand } from '../document/laid_by';
import { setOutline } from '../document/outlines';
import type { Outline } from '../document/types';
import type { FramePoint } from '../geometry/points';
import { texts } from '../texts/texts';
import { brushed } from './pixels';

/** Why a brush cannot do anything here; null where it can. */
export function brushRefusal(before: Outline | null, erase: boolean): string | null {
  if (before && !before.closed) return texts.tracing.said.closedFirst;
  return !before && erase ? texts.tracing.said.nothingToErase : null;
}

/** The stroke on the outline from before it. */
export function paint(place: Place, before: Outline | null, stroke: readonly FramePoint[], radius: number, erase: boolean): Command {
  const { points, unknownSides } = brushed(before, stroke, radius, erase);
  const outline = points.length > 0 ? { points, closed: true, unknownSides, ...byHand(before) } : null;
  return setOutline(place, erase ? texts.steps.erase : texts.steps.paint, outline);
}
