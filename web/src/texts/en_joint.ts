/** English of the joint before it is opened. */
export const joint = {
  region: 'Joint',
  title: 'Joint curves',
  open: 'Show how the joint moves',
  close: 'Hide the joint’s curves',
  save: 'Export…',
  saveTitle: 'Numbers, figure, report and film; what is unrefined, unchecked, doubtful or missing is said before',
  oneComponent: 'A joint needs both components: give the other one’s model, or its poses. Poses of one are saved under Save.',
  undecided: 'another pose fits as well',
};
