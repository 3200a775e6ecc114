import { createHash } from 'node:crypto';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { transformWithOxc, type Plugin } from 'vite';
import { filesBelow, isForThePage } from './files.ts';

const SOURCE = new URL('../service_worker/service_worker.ts', import.meta.url);

/** What the worker is called in the built page: never hashed, as the browser looks for a newer one under its name. */
const NAME = 'service_worker.js';

/**
 * Writes the service worker with the list of all files of the built page, each with a digest of its content: the same
 * files give the same worker, and any change gives another.
 */
export function offline(): Plugin {
  let folder = '';
  return {
    name: 'offline',
    apply: 'build',
    configResolved: (config) => {
      folder = join(config.root, config.build.outDir);
    },
    closeBundle: async () => {
      const list = filesBelow(folder).filter((path) => isForThePage(path) && path !== NAME);
      const files = Object.fromEntries(list.map((path) => [address(path), digest(readFileSync(join(folder, path)))]));
      const { code } = await transformWithOxc(readFileSync(SOURCE, 'utf8'), NAME.replace('.js', '.ts'));
      writeFileSync(join(folder, NAME), `const FILES = ${JSON.stringify(files, null, 1)};\n${code.replace(/^export \{\};?$/m, '')}`);
    },
  };
}

/** The page itself is asked for by its folder: some hosts redirect `index.html` there. */
function address(path: string): string {
  return path === 'index.html' ? '' : path;
}

/** As `fetch` takes it for `integrity`. */
function digest(bytes: Uint8Array): string {
  return `sha256-${createHash('sha256').update(bytes).digest('base64')}`;
}
