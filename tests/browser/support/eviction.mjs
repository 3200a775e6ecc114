/** The browser takes its storage of the page away, as it does when the disk is full. By Chromium's protocol. */
import { ADDRESS, drawn } from './browser.mjs';

/** Until the page has heard of it, which on a busy machine is later than it happens. @param {import('playwright-core').Page} page a page that keeps something */
export async function evict(page) {
  await page.evaluate(connect);
  const session = await page.context().newCDPSession(page);
  await session.send('Storage.clearDataForOrigin', { origin: new URL(ADDRESS).origin, storageTypes: 'indexeddb' });
  await page.evaluate(() => globalThis.connectionIsGone);
  await drawn(page);
}

/** Runs in the page: a connection beside its own, which hears the same. */
async function connect() {
  const asked = indexedDB.open('fluoropose');
  await new Promise((resolve, reject) => {
    asked.onsuccess = resolve;
    asked.onerror = () => reject(asked.error);
  });
  globalThis.connectionIsGone = new Promise((resolve) => (asked.result.onclose = () => resolve(null)));
}
