import type { Outline } from '../document/types';
import { texts } from '../texts/texts';
import type { Hit } from './hit';
import type { ToolName } from '../terms/tool';

/** What the tools' hints depend on besides the outline. */
export interface TracingSituation {
  readonly erase: boolean;
  /** A region was taken and its level can still be moved. */
  readonly adjusting: boolean;
  /** The component has a pose in this frame. */
  readonly posed: boolean;
}

/** What the next click does with the tools that shape outlines; null for all other tools. */
export function tracingHint(tool: ToolName, component: string, outline: Outline | null, hit: Hit, situation: TracingSituation): string | null {
  const { wire, threshold, oneClick, brush, transform, stretch } = texts.tracing.hints;
  switch (tool) {
    case 'wire':
      if (outline?.closed) return null;
      if (!outline) return wire.first(component);
      return hit.kind === 'vertex' && hit.index === 0 ? wire.closeHere : wire.next;
    case 'threshold':
      return situation.adjusting ? threshold.taken : threshold.first(component);
    case 'one-click':
      return oneClick(component);
    case 'brush':
      if (outline && !outline.closed) return brush.draft;
      return situation.erase ? brush.erase : brush.add;
    case 'transform':
      return outline ? transform.all : transform.none(component);
    case 'stretch':
      return outline?.closed ? stretch.all : stretch.none;
    default:
      return null;
  }
}
