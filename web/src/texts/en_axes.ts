import type { ComponentName } from '../terms/component';
import { asSentence } from './sentences';

/** English of anatomical axes: which way a component lies in the coordinates of its file. */
export const axes = {
  heading: 'Axes',
  /** Three of x, -x, y ...; the third is that of `third`. */
  words: (anterior: string, superior: string, other: string, third: string) => `${anterior} anterior, ${superior} superior, ${other} ${third}`,
  /** Where the file's own axes are others. */
  turned: (anterior: string, superior: string, other: string, third: string) => `anterior ${anterior}, superior ${superior}, ${third} ${other}`,
  lateral: 'lateral',
  right: 'right',
  from: { shape: 'Found from its shape', person: 'As you said', study: 'As the study file says' },
  sentence: (words: string, from: string) => `${from}: ${words}.`,
  notTheFront: (words: string) => `Found from its shape: ${words}, or facing the other way. Its shape does not tell front from back.`,
  unsigned: {
    femur: 'Its shape tells its mediolateral line alone. Which of the file’s axes are anterior and superior?',
    tibia: 'Its shape tells the lines of its axes, not which way they go. Which of the file’s axes are anterior and superior?',
  },
  nothing: 'Its shape does not tell its axes. Which of the file’s axes are anterior and superior?',
  finding: 'They are being found from its shape.',
  assumed: 'Without its model the file’s own are taken: x anterior, y superior, z right. Its model tells others, or say them here.',
  question: 'Which way is the front?',
  fronts: { 'as shown': 'As shown', 'the other way': 'The other way' },
  film: (front: 'as shown' | 'the other way', frames: number, other: string) =>
    `In ${frames === 1 ? 'the frame' : `all ${frames} frames`} with both poses it faces as the ${other} does if the front is ${front}.`,
  anterior: 'Anterior',
  superior: 'Superior',
  third: (word: string) => `to the patient’s right: ${word}`,
  choose: 'To say others, choose both.',
  skew: 'These two lie along one line: choose another.',
  use: 'Use these axes',
  reset: 'As its shape tells',
  picture: 'Model and axes',
  canvas: (component: string, words: string) => `${component} with its axes: ${words}; drag or use the arrows to look from elsewhere`,
  /** In the panel, while somebody is asked. */
  card: 'Axes to be told',
  cardText: {
    front: (component: string) => `Which way is the front of the ${component}? Its shape does not tell; joint angles wait for it.`,
    axes: (component: string) => `Which way does the ${component} lie? Its shape does not tell; joint angles wait for it.`,
    assumed: (component: string) => `No model of the ${component}: joint angles take its poses’ own axes, x anterior, y superior, z right.`,
  },
  look: 'Look and say',
  arrows: { anterior: 'anterior', superior: 'superior' },
  perhaps: (name: string) => `${name}?`,
};

function unitOf(mm: number): string {
  return mm === 1000 ? 'metres' : mm === 10 ? 'centimetres' : mm === 25.4 ? 'inches' : `units of ${mm} mm`;
}

/** English of what was done to a model when it was opened, and of study files. */
export const models = {
  card: 'About the model',
  remarks: (name: string, remarks: readonly string[]) => `${name}: ${remarks.map(asSentence).join(' ')}`,
  dismiss: 'Dismiss',
  /** By the millimetres in one of it. */
  isIn: (mm: number) => `It is in ${unitOf(mm)}`,
  isInTitle: (mm: number) => `Every length of the model times ${mm}, written as a file in millimetres, which takes its place; Ctrl+Z takes it back`,
  taken: (from: string, to: string, mm: number) => `${from} was read in ${unitOf(mm)} and written again as ${to}, in millimetres: poses are those of this file.`,
  /** Of a model that lies where the other one belongs. */
  shape: { femur: 'a tibial tray', tibia: 'a femoral component' } satisfies Record<ComponentName, string>,
  misplaced: (name: string, shape: string, component: string) => `${name} has the shape of ${shape} and is the model of the ${component}.`,
  swapped: 'Femur and tibia seem to be swapped.',
  swap: 'Swap them',
  swapTitle: 'Each model becomes that of the other component, and poses are found anew; Ctrl+Z takes it back',
  besides: (what: string, shape: string) => `${what}, though it has the shape of ${shape}`,
  dismissTitle: 'It stays readable under the component above',
};

export const study = {
  opened: (name: string) => `the study ${name}`,
  notRead: (why: string) => `it is not read as a study: ${why}`,
  wrongAxes: (component: string, words: string) =>
    `the axes of the ${component}, "${words}", are not three of x, -x, y, -y, z and -z, or directions as (0.6, 0, 0.8), that make a right-handed frame: anterior, superior, right`,
  wrongFilm: 'of [film] either curvature (0 to 1) and blur_px (above 0, at most 12) are stated, or display and blur_px, or one of these',
  otherImages: (count: number, names: string) => `${count === 1 ? 'One image is' : `${count} images are`} not in the study’s folder of frames and left out: ${names}.`,
  otherPoses: (count: number, names: string) => `${count === 1 ? 'One file of poses is' : `${count} files of poses are`} not the study’s reference and left out: ${names}.`,
  place: 'study',
};
