import { cellOf, chosenCandidate, type Doc, type FrameEntry } from '../document/types';
import type { PoseNumbers } from '../geometry/pose_numbers';
import type { ComponentName } from '../terms/component';
import { byName } from './name_order';

/** The poses of a component, a row a frame; null where there is none. */
export function posesOf(doc: Doc, component: ComponentName): readonly (PoseNumbers | null)[] {
  return doc.frames.map(({ id }) => chosenCandidate(cellOf(doc, id, component))?.pose ?? null);
}

/**
 * The row of each frame in a file of poses that names none: row and frame go together where there are as many rows as frames. Where files of
 * frames could not be read, and there are rows for them too, each row stays with its own file. Null: which row is meant for which frame is not known.
 */
export function rowsOfFrames(rows: number, frames: readonly FrameEntry[], unread: readonly string[]): readonly number[] | null {
  if (rows === frames.length) return frames.map((_, index) => index);
  if (unread.length === 0 || rows !== frames.length + unread.length || !isOneFileEach(frames)) return null;
  const names = frames.map(({ name }) => name);
  const all = [...names, ...unread].sort(byName);
  const found = names.map((name) => all.indexOf(name));
  // Frames in another order than their names have are somebody's own order, in which nobody knows where the others would be.
  return new Set(all).size === all.length && found.every((row, at) => at === 0 || row > found[at - 1]!) ? found : null;
}

/** How many frames a file would have had that could not be read is known where the others have one. */
function isOneFileEach(frames: readonly FrameEntry[]): boolean {
  return new Set(frames.map(({ source }) => source)).size === frames.length && frames.every(({ name, indexInSource }) => indexInSource === 0 && !/ #\d+$/.test(name));
}
