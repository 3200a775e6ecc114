/** English of folders and videos. */
export const files = {
  folder: 'Open a folder',
  folderTitle: 'Open all of a folder: frames, models, calibration, masks, whatever it holds',
  reading: 'Reading files',
  readingMuch: (megabytes: number) => `Reading ${megabytes} MB ...`,
  files: 'files',
  leftOut: (count: number, names: string) => `${count === 1 ? 'One file was' : `${count} files were`} not recognised and left out: ${names}.`,
  andMore: (count: number) => `${count} more`,
  nothing: 'There is nothing in it that this page opens.',
  called: 'Reading was called off; nothing was opened.',
  modelNotes: (what: string, notes: string) => `${what} (${notes})`,

  /** Several files of poses of one component. */
  sets: {
    title: 'Which poses?',
    meaning: 'There are several files of poses of one component. One of them is used, as the poses to begin with and to compare with.',
    of: (component: string) => `Poses of the ${component}`,
    leaveOut: 'None of them',
    use: 'Use these',
    none: 'There is nothing to choose.',
    ask: (component: string, names: string) => `There are several files of poses of the ${component}: ${names}. Which one?`,
    choose: 'Choose',
  },

  video: {
    sheet: 'Frames of a video',
    facts: (name: string, width: number, height: number, seconds: string, rate: string) =>
      `${name}: ${width} x ${height} px, ${seconds} s, about ${rate} frames a second.`,
    compressed:
      'A video is compressed: edges may have moved by a pixel or more, and frames that look alike may be copies. Take the frames from the machine as DICOM if you can.',
    picture: (seconds: string) => `Picture at ${seconds} s`,
    from: 'From',
    to: 'To',
    every: 'Every',
    everyUnit: 'frames',
    count: (frames: number) => `${frames === 1 ? '1 frame' : `${frames} frames`} will be taken.`,
    none: 'No frame lies in this stretch: choose a longer one.',
    take: 'Take these frames',
    taking: 'Taking frames of the video',
    measuring: 'Looking at the video',
    unit: 'frames',
    taken: (count: number, name: string, seconds: string) =>
      `${count} frames taken from ${name}, ${seconds}. Compression may have moved edges; they are kept as grey PNG images, as they were shown.`,
    repeated: (count: number) => `${count} repeated ones left out`,
    noneRepeated: 'none repeated',
    called: (count: number) => `Called off; the ${count} frames taken so far are kept.`,
    frameName: (stem: string, number: string, seconds: string) => `${stem} ${number} (${seconds} s).png`,
    cannot: (name: string) =>
      `${name}: this browser cannot decode this video. Convert it to MP4 (H.264) or WebM, or better export its frames as DICOM, TIFF or PNG.`,
    oneAtATime: 'Videos are opened one at a time: the first one is shown, open the others afterwards.',
    noSize: (name: string) => `${name}: this video has no pictures in it.`,
  },
};
