import type { Store, Theme } from '../document/store';
import { attempt } from './attempt';

const KEY = 'fluoropose-theme';

/** Brings back the theme that was chosen last, else the dark one, whatever the system's is: a frame is read in the dark. Shows each new one, and remembers it where the browser keeps anything. */
export function rememberTheme(store: Store, root: HTMLElement): void {
  if (attempt(() => localStorage.getItem(KEY)) === 'light') store.show({ theme: 'light' });
  let shown: Theme | null = null;
  const show = () => {
    const { theme } = store.ui;
    if (theme === shown) return;
    // What nobody chose is not remembered.
    if (shown) attempt(() => localStorage.setItem(KEY, theme));
    shown = root.dataset['theme'] = theme;
  };
  show();
  store.subscribe(show);
}

export function otherTheme(theme: Theme): Theme {
  return theme === 'dark' ? 'light' : 'dark';
}
