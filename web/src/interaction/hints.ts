import { tracingHint, type TracingSituation } from './tracing_hints';
import type { Outline } from '../document/types';
import { FEWEST_POINTS, type Hit } from './hit';
import type { ToolName } from '../terms/tool';
import { texts } from '../texts/texts';

/** One line: what the next click does. */
export function hint(
  tool: ToolName,
  component: string,
  outline: Outline | null,
  hit: Hit,
  situation: TracingSituation = { erase: false, adjusting: false, posed: false },
): string {
  // What is done already is not asked for.
  if (situation.posed && tool === 'one-click') return texts.hints.again(component);
  if (situation.posed && !outline && (tool === 'edit' || tool === 'trace')) return texts.hints.posed(component);
  const ofTool = tracingHint(tool, component, outline, hit, situation);
  if (ofTool !== null) return ofTool;
  switch (tool) {
    case 'hand':
      return texts.hints.hand;
    case 'window':
      return texts.hints.window;
    case 'edit':
      return outline ? editHint(outline, hit) : texts.hints.noOutline(component);
    case 'trace':
    default:
      return outline?.closed ? editHint(outline, hit) : draftHint(component, outline?.points.length ?? 0, hit);
  }
}

function editHint(outline: Outline, hit: Hit): string {
  if (hit.kind === 'vertex') return texts.hints.onPoint(hit.index + 1);
  if (hit.kind === 'edge') return texts.hints.onSide;
  if (!outline.closed) return texts.hints.open;
  return texts.hints.closed;
}

function draftHint(component: string, points: number, hit: Hit): string {
  if (points === 0) return texts.hints.first(component);
  if (hit.kind === 'vertex' && hit.index === 0 && points >= FEWEST_POINTS) return texts.hints.closeHere;
  return points < FEWEST_POINTS ? texts.hints.tooFew(points) : texts.hints.goOn(points);
}
