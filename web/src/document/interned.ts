const known = new Map<string, string>();

/** The same text, but one object for all that are alike: thousands of results name the same inputs. */
export function interned(text: string): string {
  const one = known.get(text);
  if (one !== undefined) return one;
  known.set(text, text);
  return text;
}
