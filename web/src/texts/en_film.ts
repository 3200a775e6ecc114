/** How the study's frames show metal: it decides where an edge lies, and with it the depth. */
export const film = {
  card: 'Film',
  sheet: 'Film',
  open: 'Film',
  openTitle: 'How the frames show metal, and how to state it',
  /** `words` are the core's, without a full stop. */
  known: (words: string) => `${words.charAt(0).toUpperCase()}${words.slice(1)}.`,
  unknown: 'The film is not known yet: depth may be off by many millimetres, and ± says so.',
  stays: 'You checked this pose before that was known; it stays as it was.',
  alike: (px: number, other: number) => `its mirror image fits this film as well (${other.toFixed(2)} px against ${px.toFixed(2)} px)`,
  /** Why a pose comes first, once its mirror image was looked at. */
  clearer: (px: number, other: number) =>
    `On this film it leaves ${px.toFixed(2)} px, its mirror image ${Number.isFinite(other) ? `${other.toFixed(2)} px` : 'meets no edges'}.`,
  undecided: (px: number, other: number) => `Not decided: on this film it leaves ${px.toFixed(2)} px, its mirror image ${other.toFixed(2)} px.`,
  another: (px: number, other: number) => `another pose leaves less on this film (${other.toFixed(2)} px against ${px.toFixed(2)} px)`,
  before: 'This pose was refined before that was known; it stays as it was.',
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
  wrongBlur: 'A blur is between 0.3 and 3 pixels.',
};
