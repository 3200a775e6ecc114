/** What the keys do while doubtful poses are gone through, and the line below then: with the first load. */
export const checkKeys = {
  /** With so many poses to choose from. */
  hint: (poses: number) =>
    `Y marks it as checked, ${poses > 1 ? `1 ${poses > 2 ? 'to' : 'and'} ${poses} take one of its poses, ` : ''}E edits, N leaves it for later; Space held shows the frame alone.`,
  lackingHint: 'Y says that it is not there; a click (O) finds it, E places it by hand, N leaves it for later.',
  keys: {
    take: 'While a doubtful pose is on view: take the first, second or third of its rivals',
    edit: 'While a doubtful pose is on view: edit it',
  },
};
