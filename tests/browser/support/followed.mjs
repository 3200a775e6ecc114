/** A film that a test has followed, for tests of the same program that begin where it is followed: following it is dear, and not what they are about. */
import { choose } from './files.mjs';
import { atRest } from './browser.mjs';
import * as panel from './panel.mjs';

/** @typedef {import('./files.mjs').FileToOpen} FileToOpen */

/** @type {{ session: FileToOpen, frames: number } | undefined} */
let kept;

/** The session of a film that is followed, as the page has saved it, with images and models. @param {FileToOpen} session @param {number} frames */
export function keepFollowed(session, frames) {
  kept = { session, frames };
}

/** Opens it where one of so many frames is there; null where none is. @param {import('playwright-core').Page} page @param {number} frames */
export async function openFollowed(page, frames) {
  if (kept?.frames !== frames) return null;
  await choose(page, kept.session);
  await panel.waitForFrames(page, frames);
  await panel.waitForLibraries(page, 'Femur', 'Tibia');
  await atRest(page);
  return kept.session;
}
