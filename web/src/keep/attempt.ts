/** What a browser may forbid, as to keep anything: null then. */
export function attempt<T>(work: () => T): T | null {
  try {
    return work();
  } catch {
    return null;
  }
}
