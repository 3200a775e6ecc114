import type { Store, Theme } from '../document/store';

const KEY = 'fluoropose-theme';

/** Brings back the theme that was chosen last, else the one that the browser asks for; shows each new one, and remembers it where the browser keeps anything. */
export function rememberTheme(store: Store, root: HTMLElement): void {
  const kept = attempt(() => localStorage.getItem(KEY)) ?? (matchMedia('(prefers-color-scheme: light)').matches ? 'light' : null);
  if (kept === 'light') store.show({ theme: kept });
  let shown: Theme | null = null;
  const show = () => {
    const { theme } = store.ui;
    if (theme === shown) return;
    // What nobody chose is not remembered: the browser may ask for the other one tomorrow.
    if (shown) attempt(() => localStorage.setItem(KEY, theme));
    shown = root.dataset['theme'] = theme;
  };
  show();
  store.subscribe(show);
}

export function otherTheme(theme: Theme): Theme {
  return theme === 'dark' ? 'light' : 'dark';
}

function attempt<T>(work: () => T): T | null {
  try {
    return work();
  } catch {
    return null;
  }
}
