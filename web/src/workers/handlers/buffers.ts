/** Buffers of all arrays in a message, each once. */
export function buffersIn(message: unknown): ArrayBuffer[] {
  return [...new Set(found(message))];
}

function found(value: unknown): ArrayBuffer[] {
  if (ArrayBuffer.isView(value)) return value.buffer instanceof ArrayBuffer ? [value.buffer] : [];
  return value !== null && typeof value === 'object' ? Object.values(value).flatMap(found) : [];
}
