import { nextRedo, nextUndo } from '../document/history';
import { currentCell, type Store } from '../document/store';
import { texts } from '../texts/texts';

/** A step back or forward, and a word on what it was: it may lie in a frame that nobody has on view, or change what is not in sight. */
export function undo(store: Store): void {
  // What was done last is a click, while it is still answered.
  const click = store.ui.jobs.findLast(({ at }) => at !== undefined);
  if (click) {
    click.cancel();
    store.say('info', texts.said.clickTakenBack);
    return;
  }
  const step = nextUndo(store.state.history);
  store.undo();
  tell(store, step ? texts.said.undone(step.label, whereOf(store, step)) : texts.said.nothingToUndo);
}

export function redo(store: Store): void {
  const step = nextRedo(store.state.history);
  store.redo();
  tell(store, step ? texts.said.redone(step.label, whereOf(store, step)) : texts.said.nothingToRedo);
}

/** Of an outline that is being drawn the line says already how many points it has and what the next click does, which news would hide. */
function tell(store: Store, sentence: string): void {
  if (currentCell(store.state).outline?.closed === false) store.quiet();
  else store.say('info', sentence);
}

/** Frame and component of a step that is about one cell, while that frame is there. */
function whereOf(store: Store, { place }: NonNullable<ReturnType<typeof nextUndo>>): string | null {
  const index = place ? store.doc.frames.findIndex(({ id }) => id === place.frameId) : -1;
  return place && index >= 0 ? texts.said.where(index + 1, texts.component[place.component]) : null;
}
