import type { Candidate, Cell, Outline } from './types';

/** The outline that a candidate was found with: it comes and goes with the candidate until somebody changes it. */
const found = new WeakMap<Candidate, Outline>();

export function setItsOutline(candidate: Candidate, outline: Outline): void {
  found.set(candidate, outline);
}

export function itsOutline(candidate: Candidate | undefined): Outline | null {
  return (candidate && found.get(candidate)) ?? null;
}

/** The cell with the outline of a candidate, where that came with it and the outline on view is still such a one. */
export function withItsOutline(cell: Cell, candidate: Candidate | undefined): Cell {
  const own = candidate && found.get(candidate);
  const candidates = cell.result?.kind === 'posed' ? cell.result.candidates : [];
  const untouched = candidates.some((one) => found.get(one) === cell.outline);
  return own && untouched ? { ...cell, outline: own, resultOf: own } : cell;
}
