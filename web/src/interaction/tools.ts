import type { ToolName } from '../terms/tool';
import { texts } from '../texts/texts';

/** The tools of the rail, each with its one-letter key. */
export const TOOLS = [
  { name: 'edit', key: 'v', title: texts.keys.tools.edit, cursor: 'default' },
  { name: 'trace', key: 'p', title: texts.keys.tools.trace, cursor: 'crosshair' },
  { name: 'wire', key: 'l', title: texts.keys.tools.wire, cursor: 'crosshair' },
  { name: 'threshold', key: 't', title: texts.keys.tools.threshold, cursor: 'crosshair' },
  { name: 'one-click', key: 'o', title: texts.keys.tools['one-click'], cursor: 'crosshair' },
  { name: 'brush', key: 'b', title: texts.keys.tools.brush, cursor: 'none' },
  { name: 'transform', key: 'm', title: texts.keys.tools.transform, cursor: 'move' },
  { name: 'stretch', key: 'k', title: texts.keys.tools.stretch, cursor: 'pointer' },
  { name: 'pose', key: 'a', title: texts.keys.tools.pose, cursor: 'move' },
  { name: 'hand', key: 'h', title: texts.keys.tools.hand, cursor: 'grab' },
  { name: 'window', key: 'w', title: texts.keys.tools.window, cursor: 'ns-resize' },
] as const satisfies readonly { readonly name: ToolName; readonly key: string; readonly title: string; readonly cursor: string }[];
