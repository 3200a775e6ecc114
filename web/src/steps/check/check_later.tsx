import { useLater } from '../../commands/later';
import type { State } from '../../document/store';

const load = () => import('./check_card');

/** The card of the check, loaded with the first doubtful pose that somebody looks at. */
export function CheckLater({ state }: { state: State }) {
  const { checking } = state.ui;
  const loaded = useLater(checking, load);
  return loaded && checking ? <loaded.CheckCard state={state} /> : null;
}
