/**
 * Keeps the whole page, so that it opens without a network from the second time on. The build puts `FILES` before this
 * text. A newer worker waits until no page uses this one any more, or until a person says so in the page.
 */
export {};

declare const self: ServiceWorkerGlobalScope;
/** SHA-256 of each file, as `integrity` takes it, by its path in the page's folder; the page itself is ''. */
declare const FILES: Readonly<Record<string, string>>;

const CACHE = 'fluoropose-files';

self.addEventListener('install', (event) => event.waitUntil(fetchAll()));
self.addEventListener('activate', (event) => event.waitUntil(tidy()));

self.addEventListener('message', (event) => {
  if (event.data === 'take over') void self.skipWaiting();
});

self.addEventListener('fetch', (event) => {
  const path = event.request.method === 'GET' ? pathOf(event.request.url) : null;
  if (path !== null) event.respondWith(answer(event.request, path));
});

/** The file that an address of this page means; null for everything else. */
function pathOf(address: string): string | null {
  const { scope } = self.registration;
  const plain = address.replace(/[?#].*$/, '');
  if (!plain.startsWith(scope)) return null;
  const path = decodeURI(plain.slice(scope.length));
  const file = path === 'index.html' ? '' : path;
  return file in FILES ? file : null;
}

/** Under which a file is kept: versions of one file lie side by side. */
function keyOf(path: string): string {
  return `${self.registration.scope}${path}?digest=${encodeURIComponent(FILES[path] ?? '')}`;
}

async function answer(request: Request, path: string): Promise<Response> {
  const cache = await caches.open(CACHE);
  return (await cache.match(keyOf(path))) ?? fetch(request);
}

/** All of them or none: a page with a part missing would break offline. What an older version had is not fetched again. */
async function fetchAll(): Promise<void> {
  const cache = await caches.open(CACHE);
  await Promise.all(
    Object.keys(FILES).map(async (path) => {
      const key = keyOf(path);
      if (!(await cache.match(key))) await cache.put(key, await fetched(path));
    }),
  );
}

async function fetched(path: string): Promise<Response> {
  // A host that is being brought up to date may have one file of the next version already: then none is taken.
  const integrity = FILES[path] ?? '';
  const response = await fetch(self.registration.scope + path, { cache: 'no-cache', integrity });
  if (!response.ok) throw new Error(`${path || 'the page'} could not be fetched (${response.status})`);
  // A response that was redirected may not answer for a page.
  return response.redirected ? new Response(response.body, { headers: response.headers }) : response;
}

/** Drops what this version does not use, unless an older page is still open and may yet ask for its own. */
async function tidy(): Promise<void> {
  const pages = await self.clients.matchAll({ type: 'window', includeUncontrolled: true });
  if (pages.length > 1) return;
  const cache = await caches.open(CACHE);
  const used = new Set(Object.keys(FILES).map(keyOf));
  const kept = await cache.keys();
  await Promise.all(kept.filter(({ url }) => !used.has(url)).map((request) => cache.delete(request)));
}
