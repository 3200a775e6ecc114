/** What the command `report` writes, from files that the page wrote. */
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
  const folder = await temporaryFolder();
  const at = (/** @type {string[]} */ ...path) => join(folder, ...path);
  for (const part of ['poses', 'frames']) await mkdir(at(part));
  // A page does not know where its frames lie: whoever takes the study file says so.
  await writeFile(at('study.toml'), `frames = "frames"\n${study.buffer}`);
  for (const { name, buffer } of beside) await writeFile(at(name), buffer);
  for (const { name, buffer } of frames) await writeFile(at('frames', name), buffer);
  for (const [name, bytes] of Object.entries(unzipped(poses))) await writeFile(at('poses', name), bytes);
  const words = ['report', '--study', at('study.toml'), '--poses', at('poses'), '--out', at('out'), '--overlay'];
  await promisify(execFile)(setting('FLUOROPOSE_LABORATORY'), words);
  return (path) => readFile(at('out', path));
}
