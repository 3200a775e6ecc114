/** English of going through doubtful poses. */
export const check = {
  region: 'A doubtful pose',
  title: (at: number, of: number) => `Doubtful ${at} of ${of}`,
  taken: 'Another pose taken',
  rivals: 'Poses to choose from',
  rival: (number: number, chosen: boolean) => `Pose ${number}${chosen ? ', chosen' : ''}`,
  rivalTitle: (number: number) => `Take this pose (${number})`,
  misfit: (pixels: string) => `${pixels} px`,
  joint: (flexion: string, abduction: string, internal: string) => `flexion ${flexion}°, abduction ${abduction}°, internal rotation ${internal}°`,
  jointShort: (flexion: string, abduction: string, internal: string) => [`flex ${flexion}°`, `abd ${abduction}°`, `int ${internal}°`],
  noJoint: 'no joint angles: the other component, the side or the axes are not known',
  accept: 'Accept',
  acceptTitle: 'It is right: mark it as checked and go on to the next (Y)',
  edit: 'Edit',
  editTitle: 'Change the outline, or the pose by hand (E)',
  next: 'Later',
  nextTitle: 'Leave it for later and go on to the next (N)',
  hint: 'Y accepts it, 1 to 3 take one of its poses, E edits, N leaves it for later; Space held shows the frame alone.',
  keys: {
    take: 'While a doubtful pose is on view: take the first, second or third of its rivals',
    edit: 'While a doubtful pose is on view: edit it',
  },
};
