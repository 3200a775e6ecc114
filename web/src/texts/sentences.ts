/** Sentences of what comes as half of one, from the core or from another sentence. */

/** With a full stop, unless it asks or ends by itself. */
export function ended(words: string): string {
  return /[.?!]$/.test(words) ? words : `${words}.`;
}

export function asSentence(words: string): string {
  return words === '' ? '' : ended(`${words.charAt(0).toUpperCase()}${words.slice(1)}`);
}
