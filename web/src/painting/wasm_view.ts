/**
 * Numbers of a WASM module where they lie, not copied. To be read at once: the next call into the module may write over
 * them, and where its memory grows for that call, the view is empty afterwards.
 */
export function numbersAt({ buffer }: WebAssembly.Memory, address: number, length: number): Float64Array {
  return new Float64Array(buffer, address, length);
}
