import type { FrameEntry } from './types';

/** Frames of a film that look alike to the last bit are frames of their own: between a frame's picture and its number in a row of such. */
const AGAIN = '~';

/** Frames that were opened together, each with an id of its own. */
export function distinct(frames: readonly FrameEntry[]): readonly FrameEntry[] {
  const seen = new Map<string, number>();
  return frames.map((frame) => {
    const count = (seen.get(frame.id) ?? 0) + 1;
    seen.set(frame.id, count);
    return count === 1 ? frame : { ...frame, id: `${frame.id}${AGAIN}${count}` };
  });
}

/** What frames that look alike have in common: the id of their picture. */
export function pictureOf(id: string): string {
  return id.split(AGAIN)[0] ?? id;
}
