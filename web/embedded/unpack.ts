/**
 * Runs before the program in the page that is one file: its parts (workers, WASM, the demonstration) lie in the page as
 * compressed base64 and become addresses that only this page can fetch.
 */
export {};

const TYPES: Readonly<Record<string, string>> = {
  js: 'text/javascript',
  json: 'application/json',
  png: 'image/png',
  wasm: 'application/wasm',
};

async function bytesOf(part: HTMLElement): Promise<ArrayBuffer> {
  const packed = Uint8Array.from(atob(part.textContent ?? ''), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

function addressFor(name: string, content: BlobPart[]): string {
  const type = TYPES[name.split('.').at(-1) ?? ''] ?? 'application/octet-stream';
  return URL.createObjectURL(new Blob(content, { type }));
}

async function unpack(): Promise<Record<string, string>> {
  const parts = [...document.querySelectorAll<HTMLElement>('script[data-name]')];
  const files = await Promise.all(parts.map(async (part) => ({ name: part.dataset['name'] ?? '', bytes: await bytesOf(part) })));
  for (const part of parts) part.remove();
  const isScript = (name: string) => name.endsWith('.js');
  const plain = files.filter(({ name }) => !isScript(name)).map(({ name, bytes }) => [name, addressFor(name, [bytes])]);
  const known: Record<string, string> = Object.fromEntries(plain);
  // A worker cannot see the page's table: it brings its own.
  const table = `globalThis.embedded = { address: (name) => (${JSON.stringify(known)})[name] };\n`;
  const scripts = files.filter(({ name }) => isScript(name)).map(({ name, bytes }) => [name, addressFor(name, [table, bytes])]);
  return { ...known, ...Object.fromEntries(scripts) };
}

const addresses = await unpack();

globalThis.embedded = {
  address: (name) => {
    const address = addresses[name];
    if (address === undefined) throw new Error(`${name} is not in this file`);
    return address;
  },
};
