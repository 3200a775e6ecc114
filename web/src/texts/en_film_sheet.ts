/** English of the sheet that tells what is known of the film, and takes what a person states of it. */
export const filmSheet = {
  about:
    'Where metal is thin, a frame darkens late; a logarithmic display and blur move its edges too. From the frames that have a pose the page learns by how much, so that depth from grey frames has no bias. Poses found on a frame follow; what you set or checked stays.',
  from: (profiles: number) => `From ${profiles} profiles across the outlines that have a pose.`,
  nothing: 'No frame has told it yet: it takes one pose on a frame.',
  untold:
    'One component alone does not tell a curved display from a sharpened picture. A pose of the other component does; so do you, below, where you know it.',
  display: 'Display',
  displays: { frames: 'From the frames', linear: 'Linear', between: 'Between', logarithmic: 'Logarithmic' },
  hints: {
    frames: 'Estimated from the frames',
    linear: 'Grey values in proportion to intensity',
    between: 'Neither linear nor logarithmic',
    logarithmic: 'Grey values in proportion to the logarithm of intensity, as most stations show radiographs',
  },
  blur: 'Blur',
  blurMeaning: 'Blur left empty is estimated. It holds everything that blurs: focal spot, detector, motion.',
  fix: 'State all of it',
  fixTitle: 'Takes what is known as it is, number by number: no frame is asked any more',
  unfix: 'From the frames again',
  unfixTitle: 'Estimates the film from the frames that have a pose',
  curvature: 'Curvature of the display',
  curvatureUnit: '1/grey',
  metal: (component: string) => `Attenuation of the ${component}`,
  metalUnit: '1/mm',
  constantsMeaning:
    'A curvature of 0 is linear; 1/38 shows 38 grey values for a factor of e. Attenuation is that of thin metal. A component without it is not corrected. These are taken as certain, and a study file keeps them.',
  wrongConstants: 'The curvature is 0 to 1, the blur above 0 and at most 12 pixels, an attenuation above 0.',
  wrongBlur: 'A blur is above 0 and at most 12 pixels.',
};
