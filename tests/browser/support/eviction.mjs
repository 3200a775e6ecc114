/** The browser takes its storage of the page away, as it does when the disk is full. By Chromium's protocol. */
import { ADDRESS } from './browser.mjs';

/** @param {import('playwright-core').Page} page */
export async function evict(page) {
  const session = await page.context().newCDPSession(page);
  await session.send('Storage.clearDataForOrigin', { origin: new URL(ADDRESS).origin, storageTypes: 'indexeddb' });
}
