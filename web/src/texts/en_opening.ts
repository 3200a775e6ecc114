/** What is said when files come, by what comes with them. */
export const opening = {
  archive: 'this is an archive, which the page does not look into: unpack it, and open the folder',
  steppedAside: (name: string) => `It is a study of its own: ${name || 'what was open'} is under Save, Earlier work.`,
  backTo: (name: string) => `Back to ${name || 'what was open'}`,
  /** Without its full stop. */
  dropped: (cells: number) => `${cells} followed ${cells === 1 ? 'pose is' : 'poses are'} dropped, found with the one before: Follow again, or undo`,
  tooLate: (names: string) => `${names}: other work came on view before this was read, and it was not opened. Go back to the work that it is for, and open it there.`,
  knownFrames: (count: number) => `${count === 1 ? 'One frame is' : `${count} frames are`} of this work already, by ${count === 1 ? 'its' : 'their'} content.`,
  andMoreFiles: (count: number) => `${count} more are in the list of messages.`,
  otherOrder: (byName: string, byPlace: string) =>
    `Frames stand by the names of their files, which state another order (Instance Number): ${byName} is first by name, ${byPlace} by number. Which is that of time?`,
  take: 'Order by number',
  taken: (first: string) => `The frames stand by the numbers in their files; ${first} is first. The commands go by names: rename the files for them.`,
  step: 'order the frames by number',
};
