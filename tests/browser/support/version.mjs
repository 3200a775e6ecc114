/** A newer version of the page on its host. */
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';

/** What a build with another index.html would leave on the host. @param {string} folder */
export async function newerVersion(folder) {
  const [page, worker] = [join(folder, 'index.html'), join(folder, 'service_worker.js')];
  const [before, list] = await Promise.all([readFile(page, 'utf8'), readFile(worker, 'utf8')]);
  const after = before.replace('</title>', '</title><meta name="edition" content="second">');
  assert(list.includes(digest(before)), 'the worker names the page by its digest');
  await writeFile(page, after);
  await writeFile(worker, list.replace(digest(before), digest(after)));
}

/** @param {string} text */
function digest(text) {
  return `sha256-${createHash('sha256').update(text).digest('base64')}`;
}
