/** How the study's frames show metal: it decides where an edge lies, and with it the depth. */
export const film = {
  card: 'Film',
  sheet: 'Film',
  open: 'Film',
  openTitle: 'How the frames show metal, and how to state it',
  /** `words` are the core's, without a full stop. */
  known: (words: string) => `${words.charAt(0).toUpperCase()}${words.slice(1)}.`,
  unknown: 'The film is not known yet: depth may be off by many millimetres, and ± says so.',
  checked: {
    all: 'You checked this pose before that was known; it stays as it was.',
    others: 'You checked this pose when the film was known otherwise; it stays as it was.',
  },
  alike: (px: number, other: number) => `its mirror image fits this film as well (${other.toFixed(2)} px against ${px.toFixed(2)} px)`,
  /** Why a pose comes first, once its mirror image was looked at. */
  clearer: (px: number, other: number) =>
    `On this film it leaves ${px.toFixed(2)} px, its mirror image ${Number.isFinite(other) ? `${other.toFixed(2)} px` : 'meets no edges'}.`,
  undecided: (px: number, other: number) => `Not decided: on this film it leaves ${px.toFixed(2)} px, its mirror image ${other.toFixed(2)} px.`,
  another: (px: number, other: number) => `another pose leaves less on this film (${other.toFixed(2)} px against ${px.toFixed(2)} px)`,
  unmet: "the frame has no edges where the model's outline would lie at this pose: was it found from another frame's mask or outline, or is the implant hidden here?",
  refined: {
    all: 'This pose was refined before that was known; it stays as it was.',
    others: 'This pose was refined when the film was known otherwise; it stays as it was.',
  },
};
