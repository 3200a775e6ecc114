/** The tools of the rail, each with its one-letter key. */
export const TOOLS = [
  { name: 'edit', key: 'v', title: 'Edit points', cursor: 'default' },
  { name: 'trace', key: 'p', title: 'Trace points', cursor: 'crosshair' },
  { name: 'wire', key: 'l', title: 'Live-wire', cursor: 'crosshair' },
  { name: 'threshold', key: 't', title: 'Threshold', cursor: 'crosshair' },
  { name: 'one-click', key: 'o', title: 'One click', cursor: 'crosshair' },
  { name: 'brush', key: 'b', title: 'Brush', cursor: 'none' },
  { name: 'transform', key: 'm', title: 'Move, turn, scale the outline', cursor: 'move' },
  { name: 'stretch', key: 'k', title: 'Mark a stretch unknown', cursor: 'pointer' },
  { name: 'pose', key: 'a', title: 'Adjust pose', cursor: 'move' },
  { name: 'hand', key: 'h', title: 'Move the film', cursor: 'grab' },
  { name: 'window', key: 'w', title: 'Window and level', cursor: 'ns-resize' },
] as const;

export type ToolName = (typeof TOOLS)[number]['name'];
