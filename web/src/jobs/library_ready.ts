import type { Store } from '../document/store';
import type { ComponentName } from '../terms/component';

/** Resolves when a component's library is not being built, or no longer: it is ready then, or there is none. */
export function libraryReady(store: Store, component: ComponentName): Promise<void> {
  return new Promise((resolve) => {
    const isBuilding = () => store.ui.libraries[component].state === 'building';
    if (!isBuilding()) return resolve();
    const stop = store.subscribe(() => {
      if (isBuilding()) return;
      stop();
      resolve();
    });
  });
}
