/** English of the work's steps and of the card that leads through the first frame. */
export const first = {
  steps: {
    region: 'Steps',
    count: (step: number, all: number) => `Step ${step} of ${all}`,
    names: { open: 'Open', first: 'First frame', follow: 'Follow', check: 'Check', joint: 'Joint' },
    give: { calibration: 'Give calibration', femur: 'Give a model', tibia: 'Give a model' },
    giveTitles: {
      calibration: 'Without a calibration there is no pose: open its file, type its numbers, or take it from a picture of a grid or ruler',
      femur: 'Without a model there is no pose: open the implant’s STL, OBJ or PLY file, or drop it anywhere',
      tibia: 'Without a model there is no pose: open the implant’s STL, OBJ or PLY file, or drop it anywhere',
    },
    check: (doubtful: number) => `Check ${doubtful}`,
    checkTitle: (doubtful: number, lacking: number) => {
      const poses = doubtful === 0 ? [] : [`${doubtful} ${doubtful === 1 ? 'pose is' : 'poses are'} doubtful`];
      const missing = lacking === 0 ? [] : [`${lacking}${doubtful > 0 ? '' : lacking === 1 ? ' pose' : ' poses'} ${lacking === 1 ? 'is' : 'are'} missing`];
      return `${[...poses, ...missing].join(', ')}: go through them, the worst first (N)`;
    },
  },
  card: {
    region: 'What to do next',
    click: (component: string) => `Click the ${component}`,
    now: (component: string) => `Now the ${component}`,
    clickText: 'Anywhere inside it: outline and pose come by themselves.',
    preparing: (component: string) => `The views of the ${component} are being prepared: a click waits for them.`,
    followText: (poses: number) => `${poses} ${poses === 1 ? 'pose is' : 'poses are'} still to be found. What you set by hand or checked stays as it is; what you clicked is refined with the film.`,
    shaky: (components: string) => `The pose of the ${components} is doubtful, and so would be what follows from it: look at it first.`,
    look: 'Doubtful: look at it',
    follow: 'Follow the film',
    notRight: 'Not right? Trace it instead',
    trace: 'Trace it instead',
    traceTitle: 'Trace the outline by clicks around it (P)',
  },
};
