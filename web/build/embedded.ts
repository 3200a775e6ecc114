import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import { transformWithOxc, type Plugin, type UserConfig } from 'vite';
import { filesBelow, isForThePage } from './files.ts';
import { hashSource, policyElement, readPolicy, type Policy } from './policy.ts';

const UNPACK = new URL('../embedded/unpack.ts', import.meta.url);

/** The one file, in the folder of the build (`vite build --mode embedded`). */
const NAME = 'fluoropose.html';

const CONFIG: UserConfig = {
  worker: { format: 'iife' },
  build: {
    outDir: 'dist-embedded',
    copyPublicDir: false,
    modulePreload: false,
    rolldownOptions: { output: { codeSplitting: false } },
  },
  experimental: {
    renderBuiltUrl: (name, { hostType }) =>
      hostType === 'js' ? { runtime: `globalThis.embedded.address(${JSON.stringify(name)})` } : { relative: true },
  },
};

/** Puts the whole page with its workers, WASM and demonstration into one HTML file, which opens from the disk. */
export function embedded(): Plugin {
  let folder = '';
  let publicFolder = '';
  return {
    name: 'embedded',
    apply: 'build',
    config: () => CONFIG,
    configResolved: ({ root, build, publicDir }) => {
      folder = join(root, build.outDir);
      publicFolder = publicDir;
    },
    closeBundle: async () => {
      const { code: unpack } = await transformWithOxc(readFileSync(UNPACK, 'utf8'), 'unpack.ts');
      writeFileSync(join(folder, NAME), onePage(folder, publicFolder, unpack.replace(/^export \{\};?$/m, '')));
    },
  };
}

function onePage(folder: string, publicFolder: string, unpack: string): string {
  const html = readFileSync(join(folder, 'index.html'), 'utf8');
  const program = taken(html, /<script type="module"[^>]* src="\.\/([^"]+)"[^>]*><\/script>/);
  const styles = taken(html, /<link rel="stylesheet"[^>]* href="\.\/([^"]+)"[^>]*>/);
  const icon = taken(html, /<link rel="icon" href="\.\/([^"]+)"[^>]*>/);
  // Nothing in a script may look like its end.
  const script = `\n${unpack}\n${text(folder, program.file)}`.replaceAll('</script', '<\\/script');
  const style = text(folder, styles.file);
  const apart = new Set(['index.html', NAME, program.file, styles.file]);
  const parts = [
    ...filesBelow(folder).filter((name) => !apart.has(name)).map((name) => part(folder, name)),
    ...filesBelow(publicFolder).filter((name) => name.startsWith('demo/') && isForThePage(name)).map((name) => part(publicFolder, name)),
  ];
  const head = [policyElement(policyFor(script, style)), `<style>${style}</style>`].join('\n    ');
  const body = [...parts, `<script type="module">${script}</script>`].join('\n');
  return html
    .replace(program.element, '')
    .replace(styles.element, '')
    .replace(icon.element, () => iconElement(text(publicFolder, icon.file)))
    .replace(/\s*<link rel="(manifest|apple-touch-icon)"[^>]*>/g, '')
    .replace(/(<meta charset=[^>]*>)/, (charset) => `${charset}\n    ${head}`)
    .replace('</body>', () => `${body}\n  </body>`);
}

/** An element of the built page and the file it names. */
function taken(html: string, pattern: RegExp): { element: string; file: string } {
  const [element, file] = pattern.exec(html) ?? [];
  if (element === undefined || file === undefined) throw new Error(`the built index.html has nothing like ${pattern.source}`);
  return { element, file };
}

function text(folder: string, file: string): string {
  return readFileSync(join(folder, file), 'utf8');
}

function iconElement(svg: string): string {
  return `<link rel="icon" href="data:image/svg+xml;base64,${Buffer.from(svg).toString('base64')}" type="image/svg+xml" />`;
}

/** A block of data, which no browser runs. */
function part(folder: string, name: string): string {
  const packed = gzipSync(readFileSync(join(folder, name)), { level: 9 }).toString('base64');
  return `<script type="application/gzip" data-name="${name}">${packed}</script>`;
}

/** Nothing but this very script and style, and what they make of the file's own parts. */
function policyFor(script: string, style: string): Policy {
  return new Map([
    ...readPolicy(),
    ['script-src', `${hashSource(script)} 'wasm-unsafe-eval'`],
    ['style-src', hashSource(style)],
    ['worker-src', 'blob:'],
    ['connect-src', 'blob: data:'],
    ['img-src', 'blob: data:'],
    ['manifest-src', "'none'"],
  ]);
}
