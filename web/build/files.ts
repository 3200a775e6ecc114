import { readdirSync } from 'node:fs';
import { join, relative, sep } from 'node:path';

/** Every file below a folder, by its path from there with forward slashes, in a fixed order. */
export function filesBelow(folder: string): string[] {
  const entries = readdirSync(folder, { recursive: true, withFileTypes: true });
  const files = entries.filter((entry) => entry.isFile()).map((entry) => join(entry.parentPath, entry.name));
  return files.map((file) => relative(folder, file).split(sep).join('/')).sort();
}

/** Of the demonstration the page asks for what its manifest names; masks and true poses are for tests. */
export function isForThePage(path: string): boolean {
  return !/(^|\/)\.|^demo\/(masks\/|.*\.(jts|toml)$)/.test(path);
}
