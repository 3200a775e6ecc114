/** A mask in the run lengths of the COCO data set. */
export interface Runs {
  readonly width: number;
  readonly height: number;
  /** Pixels outside, then inside, and so on by turns, down one column after the other. */
  readonly counts: readonly number[];
}

/** What a frame may have, px. */
const MOST_SIDE = 8192;

/**
 * Of an annotation's segmentation, plain or packed: there a count is in letters of six bits from "0" on, five of them of the number, the lowest
 * first, the last with its sign, and from the fourth on a count is told as the difference from the one two before. Null where it is none.
 */
export function runsOf(segmentation: unknown): Runs | null {
  if (typeof segmentation !== 'object' || segmentation === null) return null;
  const { size, counts } = segmentation as { readonly size?: unknown; readonly counts?: unknown };
  if (!Array.isArray(size) || size.length !== 2 || !size.every((side) => Number.isInteger(side) && side > 0 && side <= MOST_SIDE)) return null;
  const [height, width] = size as [number, number];
  const read = typeof counts === 'string' ? unpacked(counts) : counts;
  if (!Array.isArray(read) || !read.every((count) => Number.isInteger(count) && count >= 0)) return null;
  const runs: Runs = { width, height, counts: read as number[] };
  return runs.counts.reduce((sum, count) => sum + count, 0) === width * height ? runs : null;
}

function unpacked(letters: string): readonly number[] {
  const counts: number[] = [];
  let [count, bits] = [0, 0];
  for (const letter of letters) {
    const six = letter.charCodeAt(0) - 48;
    // No count has as many bits.
    if (six < 0 || six > 63 || bits > 30) return [NaN];
    count += (six & 31) * 2 ** bits;
    bits += 5;
    if (six & 32) continue;
    if (six & 16) count -= 2 ** bits;
    counts.push(counts.length > 2 ? count + counts[counts.length - 2]! : count);
    [count, bits] = [0, 0];
  }
  return bits === 0 ? counts : [NaN];
}

/** The same row by row, 1 inside. */
export function maskOfRuns({ width, height, counts }: Runs): Uint8Array<ArrayBuffer> {
  const mask = new Uint8Array(width * height);
  let at = 0;
  counts.forEach((count, index) => {
    const end = at + count;
    for (; index % 2 === 1 && at < end; at++) mask[(at % height) * width + Math.floor(at / height)] = 1;
    at = end;
  });
  return mask;
}
