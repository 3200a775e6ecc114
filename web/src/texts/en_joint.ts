/** English of the joint before it is opened. */
export const joint = {
  region: 'Joint',
  title: 'Joint curves',
  open: 'Show how the joint moves',
  close: 'Hide the joint’s curves',
  save: 'Export…',
  saveTitle: 'Numbers, figure, report and film; what is unrefined, unchecked, doubtful or missing is said before',
  undecided: 'another pose fits as well',
};
