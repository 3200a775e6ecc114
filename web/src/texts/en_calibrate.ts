/** English of calibrating that work in the background says: with the first load. */
export const calibrate = {
  sheet: 'Calibrate from a grid or ruler',
  open: 'Calibrate from a grid or ruler',
  noFrame: 'There is no frame to look at: open the frame of the grid first.',
  searching: 'Looking for beads',
  found: (beads: number, marks: number) =>
    `${beads} beads in a lattice${marks > beads ? `; ${marks - beads} other round marks are left out` : ''}.`,
  removed: 'The correction of distortion is taken away.',
  applied: {
    frames: 'Frames are shown undistorted; outlines went with them.',
    outlines: 'Outlines are undistorted before poses are worked out; frames stay as they were taken.',
  },
  otherSizes: (count: number, width: number, height: number) =>
    `${count === 1 ? 'One frame has' : `${count} frames have`} another size than ${width} x ${height} px and stay as they are.`,
  distortedFrame:
    'outlines alone are undistorted, and this looks at the frame, which is not. Choose "Undistort the frames" in the calibration helper first',
  opened: (name: string) => `the correction of distortion ${name}`,
  calibrated: (name: string) => `Calibration taken: ${name}.`,
};
