/** English of the sheets of calibration and convergence. */

export const calibration = {
  none: 'No calibration yet. Drop its file (JT_INTCALIB, MayaCam 2.0, a camera matrix of OpenCV, ROS or MATLAB), or type the numbers.',
  nameOnly: (name: string) => `${name}.`,
  facts: (name: string, focal: string, column: string, row: string) =>
    `${name}: focal length ${focal} px, principal point at ${column}, ${row} px.`,
  distance: 'Principal distance',
  pitch: 'Pixel pitch',
  pointX: 'Principal point x',
  pointY: 'Principal point y',
  meaning: "Distance from the X-ray focus to the detector; principal point from the frame's middle, x to the right, y up.",
  frameSize: (width: number, height: number) => `The frame has ${width} x ${height} px.`,
  typedName: 'typed',
  use: 'Use these numbers',
  open: 'Open a calibration file',
};

export const convergence = {
  none: 'A refined pose has one; there is none here.',
  following: 'Following it ...',
  refining: 'Refining it once more ...',
  refused: (why: string) => `Not to be followed: ${why}`,
  noStep: 'Not a step was needed.',
  summary: (poses: number, renders: number) =>
    `${poses} poses, the model drawn ${renders} times. Each stage looks less far around the outline and trusts what is far off less.`,
  region: 'Steps of refinement',
  table: 'Poses on the way',
  columns: ['Stage', 'Drawn', 'Residual px', 'x mm', 'y mm', 'z mm', 'z rot °', 'x rot °', 'y rot °'],
  chart: (first: string, last: string, most: number) => `Residual from ${first} to ${last} px over ${most} drawings`,
  pixels: (value: number) => `${value} px`,
  drawings: (count: number) => `${count} drawings`,
};
