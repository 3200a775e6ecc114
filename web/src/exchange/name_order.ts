/**
 * The order of names of files, which is that of the frames: `f2` before `f10`, large letters as small ones, whatever the browser's language. The
 * commands have the same order (`wasm/decode/src/names/order.rs`).
 */
export function byName(a: string, b: string): number {
  return collator.compare(a, b) || Number(a > b) - Number(a < b);
}

const collator = new Intl.Collator('en', { numeric: true });
