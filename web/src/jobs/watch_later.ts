import { CellIndex } from '../document/cells';
import type { Cell } from '../document/types';
import { work } from '../workers/activity';
import { sentenceOf } from './services';
import type { watchPoses } from './watches';

/** Loads what holds poses against each other with the first of them. */
export function watchLater(...[services, worker]: Parameters<typeof watchPoses>): void {
  const { store } = services;
  const stop = store.subscribe(() => {
    if (posed.in(store.doc.cells).length === 0) return;
    stop();
    const over = work.begin();
    import('./watches')
      .then(({ watchPoses }) => watchPoses(services, worker), (error: unknown) => store.say('error', sentenceOf(error)))
      .finally(over);
  });
}

const posed = new CellIndex<Cell>(({ cell }) => cell.result?.kind === 'posed');
