import type { Store } from '../document/store';
import { texts } from '../texts/texts';

/** How often a page that stays open looks for a newer version, ms. */
const LOOK_AGAIN = 60 * 60 * 1000;

/**
 * Has the service worker keep the page, so that it opens without a network. A newer version is announced and waits: it
 * takes over when the page is opened the next time, or when the person asks for it. Where there are no service
 * workers (a page from the disk, a host without https) the page works all the same, as long as it can be reached.
 */
export function keepForOffline(store: Store): void {
  if (!import.meta.env.PROD || globalThis.embedded || !('serviceWorker' in navigator)) return;
  // After the page is usable: the worker fetches everything, decoders and demonstration too.
  const begin = () => void register(store).catch(() => undefined);
  if (document.readyState === 'complete') begin();
  else window.addEventListener('load', begin, { once: true });
}

async function register(store: Store): Promise<void> {
  const registration = await navigator.serviceWorker.register('./service_worker.js', { updateViaCache: 'none' });
  const announce = () => {
    const { waiting } = registration;
    // Without a worker in charge this is the first one: there is nothing newer about it.
    if (waiting && navigator.serviceWorker.controller) tell(store, waiting);
  };
  announce();
  registration.addEventListener('updatefound', () => registration.installing?.addEventListener('statechange', announce));
  setInterval(() => void registration.update().catch(() => undefined), LOOK_AGAIN);
}

function tell(store: Store, waiting: ServiceWorker): void {
  if (store.ui.update) return;
  const update = () => {
    // Only now, and only because somebody pressed the button; the browser asks first where work is not saved.
    navigator.serviceWorker.addEventListener('controllerchange', () => location.reload(), { once: true });
    waiting.postMessage('take over');
  };
  store.show({ update });
  store.say('info', texts.top.updateSaid);
}
