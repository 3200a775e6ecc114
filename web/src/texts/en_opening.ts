/** What is said when files come, by what comes with them. */
export const opening = {
  archive: 'this is an archive, which the page does not look into: unpack it, and open the folder',
  steppedAside: (name: string) => `It is a study of its own: ${name || 'what was open'} is under Save, Earlier work.`,
  backTo: (name: string) => `Back to ${name || 'what was open'}`,
  /** Without its full stop. */
  dropped: (cells: number) => `${cells} ${cells === 1 ? 'pose is' : 'poses are'} dropped, clicked or followed with the one before: find them again, or undo`,
  waits: (names: string) => `${names}: opened as soon as what came before is.`,
  tooLate: (names: string) => `${names}: other work came on view before this was read, and it was not opened. Go back to the work that it is for, and open it there.`,
  otherStudies: (opened: string, count: number, names: string) =>
    `These are several studies. ${opened} is opened; left out, with what lies beside ${count === 1 ? 'it' : 'them'}: ${names}. Open each by its own folder.`,
  severalStudies: (folders: string) => `These are several studies: ${folders}. None was opened: open the folder of one.`,
  notNamed: (count: number, names: string, named: string) =>
    `${count === 1 ? 'One file is none' : `${count} files are none`} that the study names for its calibration, femur and tibia (${named}, from its own folder) and left out: ${names}.`,
  calibrations: 'calibrations',
  modelsOf: (component: string) => `models of the ${component}`,
  contested: (what: string, names: string) => `There are several ${what}: ${names}. None of them was taken: open the one that is meant by itself.`,
  knownFrames: (count: number) => `${count === 1 ? 'One frame is' : `${count} frames are`} of this work already, by ${count === 1 ? 'its' : 'their'} content.`,
  andMoreFiles: (count: number) => `${count} more are in the list of messages.`,
  otherOrder: (byName: string, byPlace: string) =>
    `Frames stand by the names of their files, which state another order (Instance Number): ${byName} is first by name, ${byPlace} by number. Which is that of time?`,
  take: 'Order by number',
  taken: (first: string) => `The frames stand by the numbers in their files; ${first} is first. The commands go by names: rename the files for them.`,
  step: 'order the frames by number',
  masksAlone: (count: number) =>
    `All ${count} pictures look like masks, and there are no frames that they are of: each is opened as a frame of its own. Open the film's frames with them; of masks alone the command pose finds poses.`,
};
