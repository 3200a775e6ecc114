import type { Store } from '../../src/document/store';
import { libraryKey } from '../../src/results/keys';
import type { ComponentName } from '../../src/terms/component';

/** A library that is open at once, whatever the document asks for. To be called before whoever looks at it listens to the store. */
export function keepLibraryOpen(store: Store, component: ComponentName): void {
  const open = () => {
    const key = libraryKey(store.doc, component);
    const library = store.ui.libraries[component];
    if (key !== null && !(library.state === 'ready' && library.key === key)) store.setLibrary(component, { state: 'ready', key, views: 1, bytes: 1, seconds: null });
  };
  store.subscribe(open);
  open();
}
