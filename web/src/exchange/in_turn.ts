import type { Store } from '../document/store';
import { WorkOnView } from './work_on_view';

/** What is being opened, and what waits for it. */
interface Queue {
  readonly work: WorkOnView;
  last: Promise<unknown>;
}

const queues = new WeakMap<Store, Queue>();

/** Is anything being opened, so that what comes now waits? */
export function isOpening(store: Store): boolean {
  return queues.has(store);
}

/**
 * Opens what came after what came before it: whether files belong to the work is told by what that has. All that waits is for the work that was on
 * view when the first of it came, or that this brought. True where that is on view in the end.
 */
export async function inTurn(store: Store, open: (work: WorkOnView) => Promise<void>): Promise<boolean> {
  const queue = queues.get(store) ?? { work: new WorkOnView(store), last: Promise.resolve() };
  queues.set(store, queue);
  const opening = queue.last.then(() => open(queue.work));
  const last = opening.catch(() => undefined);
  queue.last = last;
  try {
    await opening;
    return queue.work.isHere();
  } finally {
    if (queue.last === last) {
      queues.delete(store);
      queue.work.letGo();
    }
  }
}
