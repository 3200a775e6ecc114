/** The tools of the rail, each with its one-letter key. */
export const TOOLS = [
  { name: 'edit', key: 'v', title: 'Edit points', cursor: 'default' },
  { name: 'trace', key: 'p', title: 'Trace points', cursor: 'crosshair' },
  { name: 'hand', key: 'h', title: 'Move the film', cursor: 'grab' },
  { name: 'window', key: 'w', title: 'Window and level', cursor: 'ns-resize' },
] as const;

export type ToolName = (typeof TOOLS)[number]['name'];
