/** What commands write, from files that the page wrote. */
import { execFile } from 'node:child_process';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { promisify } from 'node:util';
import { setting } from './browser.mjs';
import { temporaryFolder } from './files.mjs';
import { unzipped } from './masks.mjs';

/** @typedef {import('./files.mjs').FileToOpen} FileToOpen */

/**
 * Reads a file that the command wrote.
 *
 * @typedef {(path: string) => Promise<Buffer>} Written
 */

/**
 * @param {FileToOpen} study as the page saved it
 * @param {FileToOpen} poses the page's zip for commands
 * @param {readonly FileToOpen[]} beside what the study names
 * @param {readonly FileToOpen[]} frames
 * @returns {Promise<Written>}
 */
export async function reported(study, poses, beside, frames) {
  const at = await studyFolder(study, beside, frames);
  await mkdir(at('poses'));
  for (const [name, bytes] of Object.entries(unzipped(poses))) await writeFile(at('poses', name), bytes);
  const words = ['report', '--study', at('study.toml'), '--poses', at('poses'), '--out', at('out'), '--overlay'];
  await command(words);
  return (path) => readFile(at('out', path));
}

/**
 * What `track` writes.
 *
 * @param {FileToOpen} study as the page saved it
 * @param {readonly FileToOpen[]} beside what the study names
 * @param {readonly FileToOpen[]} frames
 * @param {readonly string[]} clicks component:frame:column,row
 * @returns {Promise<Written>}
 */
export async function tracked(study, beside, frames, clicks) {
  const at = await studyFolder(study, beside, frames);
  await command(['track', '--study', at('study.toml'), '--out', at('out'), ...clicks.flatMap((click) => ['--click', click])]);
  return (path) => readFile(at('out', path));
}

/** @param {FileToOpen} study @param {readonly FileToOpen[]} beside @param {readonly FileToOpen[]} frames */
async function studyFolder(study, beside, frames) {
  const folder = await temporaryFolder();
  const at = (/** @type {string[]} */ ...path) => join(folder, ...path);
  await mkdir(at('frames'));
  // A page does not know where its frames lie: whoever takes the study file says so.
  await writeFile(at('study.toml'), `frames = "frames"\n${study.buffer}`);
  for (const { name, buffer } of beside) await writeFile(at(name), buffer);
  for (const { name, buffer } of frames) await writeFile(at('frames', name), buffer);
  return at;
}

/** @param {readonly string[]} words */
async function command(words) {
  // Poses that are doubtful are told by another exit code.
  await promisify(execFile)(setting('FLUOROPOSE_LABORATORY'), words).catch((error) => {
    if (error.code !== 3) throw error;
  });
}
