/** What the bottom line and the log say of outlines, files and poses. */
type Sized = { readonly name: string; readonly width: number; readonly height: number };

export const said = {
  tooFewPoints: (fewest: number, missing: number) => `An outline needs ${fewest} points: ${missing} more, then it can be closed.`,
  selectedPoint: (point: number, count: number) => `Point ${point} of ${count}: Delete removes it; U marks the side after it unknown.`,
  closeFirst: 'Sides can be marked unknown once the outline is closed.',
  whichSide: 'Point at a side of the outline, or select the point before it with , and . keys, then press U.',
  sideUnknown: (side: number, count: number, reach: number, fraction: number) =>
    `Side ${side} of ${count} is unknown: what lies within ${reach} px of it is ignored. ${fraction} % of the outline is unknown.`,
  taken: (number: number) => `Pose ${number} is taken; undo brings the other one back.`,
  sideKnown: (side: number, count: number, fraction: number) => `Side ${side} of ${count} is known. ${fraction} % of the outline is unknown.`,
  sessionSaved: 'Session saved, with every file it needs.',
  sessionSavedWithout: (names: string) => `Session saved, but without the bytes of ${names}, of which the page has no copy: keep the originals.`,
  sessionSavedWithoutFiles: 'Session saved; its files are named by digest, keep them.',
  posesSaved: (component: string, frames: number, without: number) =>
    `Poses of the ${component} saved, a row for each of ${frames} frames.${without === 0 ? '' : ` ${without} without a pose: rows of NaN.`}`,
  tableSaved: (component: string, frames: number) =>
    `Poses of the ${component} saved with their standard deviations, a row for each of ${frames} frames.`,

  cameraDoubt: (doubt: string) => `Camera: ${doubt}`,
  sizes: (other: Sized, first: Sized) =>
    `${other.name} is ${other.width} x ${other.height} pixels but ${first.name} is ${first.width} x ${first.height} pixels: a film has frames of one size, those that were calibrated; undo, and leave the others out.`,
  opened: (what: string) => `Opened ${what}.`,
  of: (file: string, sentence: string) => `${file}: ${sentence}`,
  outlinesNeedFrames: 'outlines are for frames: open the frames first, then the outlines',
  posesNeedFrames: 'the poses are for frames: open the frames first, then the poses',
  emptyFile: 'the file is empty; export or copy it again',
  undone: (what: string, where: string | null) => `Undone: ${what}${where ?? ''}. Ctrl+Y does it again.`,
  redone: (what: string, where: string | null) => `Done again: ${what}${where ?? ''}.`,
  where: (frame: number, component: string) => ` (frame ${frame}, ${component})`,
  nothingToUndo: 'There is nothing to undo.',
  nothingToRedo: 'There is nothing to do again.',
  clickTakenBack: 'The click is taken back; undo once more goes on before it.',
  notRecognised:
    'not recognised; the page opens frames (PNG, JPEG, TIFF, BMP, DICOM, NumPy), models (STL, OBJ, PLY), calibrations, corrections of distortion, poses (.jts, .jtak, .jtap), libraries, sessions and videos',
  theCalibration: (name: string) => `the calibration ${name}`,
  asModel: (name: string, component: string) => `${name} as the model of the ${component}`,
  asLibrary: (name: string, component: string) => `${name} as the library of the ${component}`,
  asPoses: (name: string, component: string) => `${name} as poses of the ${component}`,
  asPosesWithout: (name: string, component: string, unread: readonly string[]) =>
    `${name} as poses of the ${component} (it has rows for ${few(unread)} too, which could not be read: each row stays with its own frame)`,
  /** What a film lacks: file names of frames. */
  withoutUnread: (unread: readonly string[]) =>
    `${few(unread)} could not be read: frames are counted, and rows written, without ${unread.length === 1 ? 'it' : 'them'}.`,
  otherRows: (rows: number, frames: number, unread: readonly string[]) =>
    `${counted(rows, 'row')} of poses for ${counted(frames, 'frame')}: which belongs to which is not known, and none was taken. ${
      unread.length > 0 ? `${few(unread)} could not be read: open ${unread.length === 1 ? 'it' : 'them'} mended, then the poses. ` : ''
    }Open the frames that the poses are for, or write a row for each frame in the order of the strip, NaN six times where there is no pose.`,
  repeats: (pairs: readonly (readonly [number, number])[], more: number) =>
    `Frames ${pairs.map(([one, other]) => `${one} and ${other}`).join(', ')}${more > 0 ? ` and ${more} more pairs` : ''} are the same to the last pixel: was one written twice? They count as neighbours at even times.`,
  theFrames: (count: number, name: string) => (count === 1 ? `the frame ${name}` : `${count} frames`),
  openingFrames: (files: number) => (files === 1 ? 'Opening frames' : `Opening ${files} files of frames`),
  frames: 'frames',
  files: 'files',
  study: 'Study',
  demonstration: 'Fetching the demonstration ...',
  notFetched: (name: string, status: number) => `the demonstration's ${name} could not be fetched (${status})`,

  missing: {
    frames: 'frames',
    calibration: 'a calibration',
    model: (component: string) => `a model or a library of the ${component}`,
    building: 'its library (being built)',
    stopped: (reason: string) => `its library (${reason})`,
    outline: (component: string) => `an outline of the ${component}`,
    click: (component: string) => `a click inside the ${component} (O), or its outline`,
    closed: 'the outline closed',
  },

  library: {
    job: (component: string) => `${component} library`,
    views: 'views',
    calledOff: 'called off',
    saidCalledOff: (component: string) => `The library of the ${component} was called off; its panel builds it again.`,
    failed: (component: string, why: string) => `${component} library: ${why}`,
    noFile: 'the library file is not at hand',
    noInputs: 'the model or the calibration is not at hand',
    withoutModel: 'the library was opened without its model.',
  },
  noChoice: (why: string) => `No choice between rival poses: ${why}`,
  notShown: (component: string, why: string) => `The ${component} cannot be shown: ${why}`,
  workerStopped: (why: string) => `the worker stopped (${why}); what you have done is still here, try again`,
  notLoaded: 'it could not be loaded',
};

/** A few names, and how many more there are. */
function few(names: readonly string[]): string {
  const more = names.length - NAMED;
  return `${names.slice(0, NAMED).join(', ')}${more > 0 ? ` and ${more} more` : ''}`;
}

const NAMED = 3;

function counted(count: number, what: string): string {
  return `${count} ${what}${count === 1 ? '' : 's'}`;
}
