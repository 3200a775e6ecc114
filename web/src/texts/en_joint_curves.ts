import type { CurveName } from '../terms/joint';

interface CurveWords {
  readonly title: string;
  readonly short?: string;
  readonly sign: string;
}

/** English of the joint's curves. */
export const curves = {
  convention: 'Convention of the translations',
  conventions: { field: 'Tray axes', 'grood-suntay': 'Grood–Suntay' },
  conventionHints: {
    field: 'The origin of the femoral component in the axes of the tibial one; rotations are Grood and Suntay’s in either',
    'grood-suntay': 'The shift of the tibia from the femur along the axes of Grood and Suntay (1983)',
  },
  over: 'Over',
  overs: { frame: 'Frame', time: 'Time', flexion: 'Flexion' },
  overUnits: { frame: 'frame', time: 'time s', flexion: 'flex. °' },
  tray: {
    title: 'Tray from above',
    short: 'Tray',
    anterior: 'anterior',
    here: (frame: number) => `The tray from above with the line between the lowest points of both condyles in frame ${frame}`,
    none: (frame: number) => `The tray from above; frame ${frame} has no lowest points`,
  },
  rate: 'Frames a second',
  rateNeeded: 'Say how many frames there are in a second.',
  large: 'Large curves',
  size: 'Height of the curves',
  /** Name of a curve, also where there is little room, and what its positive numbers mean. */
  curves: {
    flexion: { title: 'Flexion', sign: 'flexion +' },
    abduction: { title: 'Abduction', sign: 'tibia abducted +' },
    internal: { title: 'Internal rotation', short: 'Int. rot.', sign: 'tibia internal +' },
    anterior: { title: 'Anterior', sign: 'femur anterior +' },
    superior: { title: 'Superior', sign: 'femur superior +' },
    medial: { title: 'Medial', sign: 'femur medial +' },
    gsAnterior: { title: 'Anterior drawer', short: 'Drawer', sign: 'tibia anterior +' },
    gsDistraction: { title: 'Distraction', short: 'Distr.', sign: 'distracted +' },
    gsLateral: { title: 'Lateral shift', short: 'Lateral', sign: 'tibia lateral +' },
    lowest: { title: 'Lowest AP', short: 'AP', sign: 'anterior +' },
    liftOff: { title: 'Lift-off', sign: 'lateral up +' },
  } satisfies Record<CurveName, CurveWords> as Record<CurveName, CurveWords>,
  beyond: (percent: string) => `P(> 1 mm) ${percent} %`,
  beyondShort: (percent: string) => `>1 mm: ${percent} %`,
  of: { medial: 'medial', lateral: 'lateral' },
  ofShort: { medial: 'M', lateral: 'L' },
  here: (title: string, frame: number) => `${title} in frame ${frame}`,
  chart: (title: string, frames: number, least: string, most: string, over: string) =>
    `${title} over ${over} in ${frames} ${frames === 1 ? 'frame' : 'frames'}, ${least} to ${most}`,
  noChart: (title: string) => `${title}: no frame has it`,
  chartTitle: 'Click to go to the frame',
  alone: (title: string) => `${title} alone`,
  all: 'All curves',
  band: 'band: one standard deviation',
  noBands: 'no bands: poses without standard deviations',
  good: 'not doubtful',
  doubtful: 'doubtful',
  checked: 'checked',
  /** A translation of the first frame of which that is so. */
  originsApart: (mm: string) =>
    `A translation is ${mm} mm, as in no knee: the origin of a model's file lies far off its component. Translations are of these origins; rotations and lowest points are free of them.`,
  /** Before a sentence of the core without its full stop. */
  impossible: (frames: string, count: number, why: string) => `${count === 1 ? 'Frame' : 'Frames'} ${frames}: ${why}. Not drawn.`,
  allDoubtful: (frames: number) => `All ${frames} frames are doubtful.`,
  hovered: (frame: number) => `numbers of frame ${frame}`,
  waiting: (frames: number) => `${frames} ${frames === 1 ? 'frame is' : 'frames are'} being worked out`,
  noPlate: { models: 'Lowest points and lift-off need both models.', tray: 'Lowest points and lift-off are not known: the tray has no plate.' },
  needs: {
    poses: 'No frame has a pose of both components yet.',
    side: 'Which knee is it? Signs depend on it.',
    sides: { left: 'Left', right: 'Right' },
    told: { left: 'The femur is made for a left one.', right: 'The femur is made for a right one.' },
    finding: (component: string) => `The axes of the ${component} are being found from its shape.`,
    front: (component: string) => `Joint angles wait: which way is the front of the ${component}?`,
    axes: (component: string) => `Joint angles wait for the axes of the ${component}.`,
  },
};
