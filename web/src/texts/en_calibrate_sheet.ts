/** English of the calibration helper and of what files state: with their sheets. */
export const calibrateSheet = {
  what: 'What the frame shows',
  kinds: { grid: 'Bead grid', ruler: 'Ruler' },
  gridMeaning:
    'A flat plate of round beads or holes in a square pattern. On the detector it shows the distortion; at a known distance from the source it shows the pixel pitch.',
  rulerMeaning: 'Click two marks of the ruler on the frame (zoom in first), or type their places. The ruler lies parallel to the detector.',
  find: 'Find the beads',
  radius: 'Bead radius',
  anyRadius: 'any',
  bright: 'Beads are brighter than what is around them',
  gridOf: (name: string, beads: number, columns: number, rows: number, missing: number) =>
    `${name}: ${beads} beads, ${columns} x ${rows} places${missing > 0 ? `, ${missing} without a bead` : ''}.`,
  distortion: 'Distortion',
  noDistortion: (why: string) => `No correction: ${why}.`,
  fitted: (before: string, after: string, order: number, dropped: number) =>
    `The beads lie ${before} px (RMS) off a regular lattice, and ${after} px after a correction of order ${order}${
      dropped > 0 ? `; ${dropped} beads far off were left out` : ''
    }.`,
  validated: (orders: string) => `Cross-validated residual: ${orders}.`,
  orderResidual: (order: number, residual: string | null) => `order ${order} ${residual === null ? 'too few beads' : `${residual} px`}`,
  largest: (shift: string) => `The largest shift of a pixel inside the grid is ${shift} px; outside it the correction is extrapolated. A plate that is not level with the detector looks distorted too: the lengths below tell.`,
  small: 'That is hardly more than the error of the bead centres: a correction is not worth it.',
  map: (times: number) => `Residuals of the beads before (thin) and after (thick) correction, ${times} times as long`,
  toFrames: 'Undistort the frames',
  toFramesTitle: 'Frames are shown undistorted; outlines that were traced go with them',
  toOutlines: 'Undistort outlines only',
  toOutlinesTitle: 'Frames stay as they were taken; outlines are undistorted when a pose is worked out',
  remove: 'Take the correction away',
  saveFile: 'Save the correction (.json)',
  openFile: 'Open a correction',
  inUse: {
    frames: (name: string, order: number, after: string) => `In use on frames: order ${order} from ${name}, ${after} px left.`,
    outlines: (name: string, order: number, after: string) => `In use on outlines: order ${order} from ${name}, ${after} px left.`,
  },
  camera: 'Camera',
  spacing: 'Bead spacing',
  length: 'Length between the marks',
  toDetector: 'Source to detector',
  toObject: { grid: 'Source to plate', ruler: 'Source to ruler' },
  mark: (number: number, axis: 'column' | 'row') => `Mark ${number} ${axis}`,
  clearMarks: 'Clear the marks',
  pitch: (pitch: string) => `Pixel pitch ${pitch} mm at the detector`,
  pitchAlone: (pitch: string, focal: string, length: string) =>
    `Pixel pitch ${pitch} mm at the detector, focal length ${focal} px, from ${length} px between the marks.`,
  point: (x: string, y: string) => `principal point ${x}, ${y} mm from the frame's middle.`,
  pointUnknown: (tilt: string) =>
    `principal point: the frame's middle. A plate this level (${tilt}°) does not show it; type it in the calibration, or, where no correction is made of the same frame, tilt the plate by 20° or more in both directions.`,
  pointOfRuler: 'The principal point is taken to be the frame’s middle: a ruler does not show it.',
  residual: (residual: string, beads: number) => `${beads} beads lie ${residual} px (RMS) from where this camera sees them.`,
  distortedFirst: (before: string) => `The picture is distorted by ${before} px (RMS): correct the distortion first, or the pitch is that of the middle at best.`,
  tiltedFirst: (tilt: string) => `As it was taken the plate is tilted by ${tilt}°, which the correction takes for distortion: this pitch is off by a part of a percent or more. Take the plate level with the detector, or leave the correction out where the picture is not distorted.`,
  distancesMatter: 'An error of either distance goes into the pitch in proportion.',
  needs: 'Type the lengths to see the camera.',
  use: 'Use as calibration',
  nameOf: { grid: (frame: string) => `grid in ${frame}`, ruler: (frame: string) => `ruler in ${frame}` },
  stated: {
    title: 'Stated by the file',
    meaning: 'Offered, not taken: check that it holds for this set-up.',
    fill: 'Fill in',
    fillLabel: (what: string) => `Fill in ${what}`,
    offer: (count: number) => `The file states ${count === 1 ? 'a size or distance' : 'sizes and distances'} that a calibration may begin with.`,
    look: 'Look at them',
    detectorSpacing: (value: string) => `Imager Pixel Spacing (0018,1164): ${value} mm between pixels at the detector.`,
    pixelSpacing: {
      plain: (value: string) =>
        `Pixel Spacing (0028,0030): ${value} mm. The file does not say where that holds: it may be the detector or the patient. Not offered.`,
      geometry: (value: string) =>
        `Pixel Spacing (0028,0030): ${value} mm at a depth in the patient that the machine assumed (GEOMETRY), not at the detector. Not offered.`,
      fiducial: (value: string) =>
        `Pixel Spacing (0028,0030): ${value} mm at the depth of an object of known size (FIDUCIAL), not at the detector. Not offered.`,
    },
    scannedSpacing: (value: string) =>
      `Nominal Scanned Pixel Spacing (0018,2010): ${value} mm between pixels on the film that was scanned, which lay at the detector.`,
    sourceToDetector: (value: string) => `Distance Source to Detector (0018,1110): ${value} mm, the principal distance.`,
    sourceToPatient: (value: string) =>
      `Distance Source to Patient (0018,1111): ${value} mm to the skin, the table or the turning point, as the maker has it; no camera needs it.`,
    sourceToIsocentre: (value: string) => `Distance Source to Isocenter (0018,9402): ${value} mm; no camera needs it.`,
    magnification: (value: string) => `Estimated Radiographic Magnification Factor (0018,1114): ${value}, at one assumed depth; no camera needs it.`,
    oblong: (across: string, along: string) =>
      `${across} x ${along} mm: the pixels are not square, and this calibration knows square ones only. Make them square first.`,
  },
};
