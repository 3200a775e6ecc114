import { currentCell, currentPlace, type State } from '../document/store';
import { checkState, markOf } from '../document/marks';
import { verdictOf } from '../document/types';
import type { App } from './app';
import type { KeyInput } from './bindings';

/** Is a doubtful pose on view, or a cell without one, by somebody who goes through them? A pose that was taken instead is, until it is accepted. */
export function isInCheck(state: State): boolean {
  const place = currentPlace(state);
  const cell = currentCell(state);
  if (!state.ui.checking || !place || !cell.result) return false;
  const isAccepted = checkState(cell, markOf(state.history.present, place)) === 'yes';
  return !isAccepted && (cell.result.kind === 'failed' || cell.result.chosen !== 0 || verdictOf(cell.result)?.word === 'doubtful');
}

/** Keys while a doubtful pose is on view: they come before what they mean otherwise. False where the key means something else. */
export function runCheckKey({ actions, services }: App, { key, ctrl, shift, alt }: KeyInput): boolean {
  const { state } = services.store;
  if (ctrl || shift || alt || !isInCheck(state)) return false;
  const { result } = currentCell(state);
  const at = Number(key) - 1;
  if (result?.kind === 'posed' && result.candidates.length > 1 && result.candidates[at]) {
    return at === result.chosen || actions.chooseCandidate(at);
  }
  if (key.toLowerCase() !== 'e') return false;
  edit(services.store);
  return true;
}

/** The points of the outline; where there is none, the model itself. */
export function edit(store: App['services']['store']): void {
  store.show({ tool: currentCell(store.state).outline ? 'edit' : 'pose' });
}
