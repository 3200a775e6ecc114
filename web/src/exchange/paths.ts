import type { Incoming } from './incoming';

/** From the top of what was dropped, without a slash before it; the name alone where nobody tells the folders. */
export function pathOf({ name, path }: Incoming): string {
  return (path ?? name).replace(/^\//, '');
}

/** The folder of a path; empty at the top. */
export function parentOf(path: string): string {
  return path.split('/').slice(0, -1).join('/');
}

export function fileName(path: string): string {
  return path.split(/[\\/]/).at(-1) ?? path;
}

/** The path that is written in a file of a folder. */
export function resolved(folder: string, written: string): string {
  const parts: string[] = [];
  for (const part of `${folder}/${written}`.split(/[\\/]/)) {
    if (part === '..') parts.pop();
    else if (part !== '' && part !== '.') parts.push(part);
  }
  return parts.join('/');
}

/** The deepest of the folders in which a file lies, directly or further down; undefined where it lies in none. */
export function nearest(folders: readonly string[], file: Incoming): string | undefined {
  const around = folders.filter((folder) => folder === '' || pathOf(file).startsWith(`${folder}/`));
  return around.sort((a, b) => b.length - a.length)[0];
}
