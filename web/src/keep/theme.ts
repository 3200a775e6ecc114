import type { Store, Theme } from '../document/store';

const KEY = 'fluoropose-theme';

/** Brings back the theme that was chosen last, shows each new one, and remembers it where the browser keeps anything. */
export function rememberTheme(store: Store, root: HTMLElement): void {
  const kept = attempt(() => localStorage.getItem(KEY));
  if (kept === 'light') store.show({ theme: kept });
  let shown: Theme | null = null;
  const show = () => {
    const { theme } = store.ui;
    if (theme === shown) return;
    shown = root.dataset['theme'] = theme;
    attempt(() => localStorage.setItem(KEY, theme));
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
