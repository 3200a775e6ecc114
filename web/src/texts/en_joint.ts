/** English of the joint before it is opened. */
export const joint = {
  region: 'Joint',
  title: 'Joint curves',
  open: 'Show how the joint moves',
  close: 'Hide the joint’s curves',
  undecided: 'another pose fits as well',
};
