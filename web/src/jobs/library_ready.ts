import type { Store } from '../document/store';
import { libraryKey } from '../results/keys';
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

/** Is the library open that the document asks for now? Until the librarian has heard of a change that is the one before. */
export function isLibraryOpen({ doc, ui }: Pick<Store, 'doc' | 'ui'>, component: ComponentName): boolean {
  const library = ui.libraries[component];
  return library.state === 'ready' && library.key === libraryKey(doc, component);
}
