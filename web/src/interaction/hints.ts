import type { Outline } from '../document/types';
import { FEWEST_POINTS, type Hit } from './hit';
import type { ToolName } from './tools';

/** One line: what the next click does. */
export function hint(tool: ToolName, component: string, outline: Outline | null, hit: Hit): string {
  switch (tool) {
    case 'hand':
      return 'Drag to move the film, wheel to zoom at the cursor, 0 to see all of it.';
    case 'window':
      return 'Drag sideways for contrast, up and down for brightness; R goes back to what the film suggests.';
    case 'edit':
      return outline ? editHint(outline, hit) : `No outline of the ${component} here: press P and click round it.`;
    case 'trace':
      return outline?.closed ? editHint(outline, hit) : draftHint(component, outline?.points.length ?? 0, hit);
  }
}

function editHint(outline: Outline, hit: Hit): string {
  if (hit.kind === 'vertex') return `Point ${hit.index + 1}: drag to move it; Alt-click or Delete removes it.`;
  if (hit.kind === 'edge') return 'Click to insert a point here; U marks this side unknown, or known again.';
  if (!outline.closed) return 'The outline is open: press P to go on tracing, Enter to close it.';
  return 'Drag a point to move it, click an edge to insert one, Alt-click a point to delete it.';
}

function draftHint(component: string, points: number, hit: Hit): string {
  if (points === 0) return `Click on the edge of the ${component} to begin its outline.`;
  if (hit.kind === 'vertex' && hit.index === 0 && points >= FEWEST_POINTS) return 'Click to close the outline here.';
  const count = points === 1 ? '1 point' : `${points} points`;
  if (points < FEWEST_POINTS) return `${count}. Click the next one along the edge; Backspace takes the last one back.`;
  return `${count}. Go on along the edge; close with a click on the first point, a double click, or Enter.`;
}
