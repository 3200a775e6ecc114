export const TOOL_NAMES = ['edit', 'trace', 'wire', 'threshold', 'one-click', 'brush', 'transform', 'stretch', 'pose', 'hand', 'window'] as const;
export type ToolName = (typeof TOOL_NAMES)[number];
