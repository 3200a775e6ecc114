/** What does not match the SHA-256 by which a session names it. */
export const digests = {
  openLabel: 'open a session',
  trouble: (what: string) => `Not as it was saved: ${what}.`,
  damaged: (name: string, found: string, wanted: string) =>
    `${name}: the copy in the session was changed (SHA-256 ${found} instead of ${wanted}); drop the original on the page`,
  missing: (names: string, count: number) => `The session only names ${names}: drop ${count === 1 ? 'it' : 'them'} on the page`,
  another: (name: string, found: string, wanted: string) =>
    `${name} is another file than the one that the session names (SHA-256 ${found} instead of ${wanted}): opened all the same, Ctrl+Z takes it back`,
};
