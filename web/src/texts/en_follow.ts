/** English of following a film. */
export const follow = {
  button: 'Follow',
  stop: 'Stop',
  title: 'Follow both components through the film from the frames that are set; what is set in none is looked for first (Shift+G)',
  stopTitle: 'Stop following, and keep what was found (Shift+G)',
  job: 'Following the film',
  reading: 'Reading the film beside the frames that are set',
  estimating: 'Estimating the constants of the film',
  comparing: 'Comparing the constants of the film with what was followed',
  again: 'Following the film again, by what all of it tells',
  deciding: 'Looking at other poses of the film',
  decidingIn: (component: string, frame: number) => `Looking at other poses of the ${component} in frame ${frame}`,
  looking: (component: string, frame: number, other: string | null) => `Looking for the ${component} ${other ? `beside the ${other} ` : ''}in frame ${frame}`,
  notFound: (component: string) =>
    `The ${component} was not found: in no frame that was searched are edges all along its outline from any side. Click it in one frame, then Follow again.`,
  outdone: (component: string, frame: number, other: number) =>
    `Your click on the ${component} in frame ${frame} led to weaker edges than the film shows in frame ${other}, which leads instead; undo brings it back.`,
  unit: 'frames',
  /** What is found, of both components: twice as many as there are frames. */
  posesUnit: 'poses',
  sourceKept: 'Followed through the film, and kept: it was checked.',
  source: 'Followed through the film; checking it, or setting the pose by hand, keeps it.',
  soFar: 'the film has not been judged as a whole yet: it is being followed, or that was broken off, and Follow goes on',
  unjudged: (component: string, frames: number) =>
    `${frames === 1 ? 'One frame' : `${frames} frames`} of the ${component} ${frames === 1 ? 'is' : 'are'} followed so far and not yet judged with the whole film: save again when that is done.`,
  fromDoubtful: 'it was followed from a pose that is doubtful itself: check that one, or set it by hand',
  accepted: (doubt: string) => `a person checked it; it was doubtful: ${doubt}`,
  /** The verdict on the pose in whose place it was taken, and why. */
  taken: (word: string, because: string) => `it was taken by hand in place of the first, which was ${word}: ${because}`,
  notJudged: 'it was not held against the frame',
  fixed: (px: number | null) => `a person fixed the pose${px === null ? '' : `, and it leaves ${px.toFixed(1)} px beside the edges`}`,
  gaveWay: 'The outline takes the place of the pose that was followed; undo brings it back.',
  oneFrame: 'There is no film to follow: open at least two frames.',
  sizes: 'The frames have different sizes: a film has one.',
  noCalibration: 'The calibration is missing: without it no pose can be followed. Drop its file anywhere, or press Calibration above to type it.',
  noneSet: 'Nothing to follow from: click the femur or the tibia in one frame first.',
  allSet: 'Every frame is followed already from those that are set.',
  gone: (frame: number) => `Frame ${frame} is gone: following stopped there.`,
  /** How many are doubtful the header counts: what film and joint tell afterwards changes it. */
  done: (posed: number, doubtful: 'none' | 'some' | 'all', missing: number, stopped: boolean) =>
    `${stopped ? 'Stopped: ' : ''}${posed} ${posed === 1 ? 'pose' : 'poses'} found${doubtful === 'none' ? '' : `, ${doubtful} doubtful: N goes from one to the next`}.${
      missing > 0 ? ` ${missing} ${missing === 1 ? 'is' : 'are'} missing (✕): a click there, or an outline, helps.` : ''
    }`,
};
