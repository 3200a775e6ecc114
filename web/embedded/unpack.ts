/**
 * Runs before the program in the page that is one file: its parts (workers, WASM, the demonstration) lie in the page as
 * compressed base64 and become addresses that can be fetched.
 *
 * On a page from the disk Chromium starts no module worker from an address made here, and lets no worker fetch one:
 * workers are plain scripts that carry the parts they need as `data:` addresses.
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

interface Part {
  readonly name: string;
  readonly type: string;
  readonly bytes: ArrayBuffer;
}

async function partOf(element: HTMLElement): Promise<Part> {
  const name = element.dataset['name'] ?? '';
  const type = TYPES[name.split('.').at(-1) ?? ''] ?? 'application/octet-stream';
  return { name, type, bytes: await bytesOf(element) };
}

function blobAddress({ type }: Part, ...content: BlobPart[]): string {
  return URL.createObjectURL(new Blob(content, { type }));
}

function dataAddress({ type, bytes }: Part): Promise<string> {
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(reader.result as string);
    reader.onerror = () => reject(reader.error ?? new Error('a part could not be read'));
    reader.readAsDataURL(new Blob([bytes], { type }));
  });
}

/** A worker's script after a table of the parts that it names. */
async function workerAddress(worker: Part, parts: readonly Part[]): Promise<string> {
  const script = new TextDecoder().decode(worker.bytes);
  const named = parts.filter(({ name }) => name !== worker.name && script.includes(name));
  const table = await Promise.all(named.map(async (part) => [part.name, await dataAddress(part)]));
  const lookup = `globalThis.embedded = { address: (name) => (${JSON.stringify(Object.fromEntries(table))})[name] };\n`;
  return blobAddress(worker, lookup, script);
}

async function unpack(): Promise<Map<string, string>> {
  const elements = [...document.querySelectorAll<HTMLElement>('script[data-name]')];
  const parts = await Promise.all(elements.map(partOf));
  for (const element of elements) element.remove();
  const addresses = parts.map(async (part) => {
    const address = part.name.endsWith('.js') ? await workerAddress(part, parts) : blobAddress(part, part.bytes);
    return [part.name, address] as const;
  });
  return new Map(await Promise.all(addresses));
}

const addresses = await unpack();

globalThis.embedded = {
  address: (name) => {
    const address = addresses.get(name);
    if (address === undefined) throw new Error(`${name} is not in this file`);
    return address;
  },
};

globalThis.Worker = class extends Worker {
  constructor(address: string | URL, options?: WorkerOptions) {
    super(address, { ...options, type: 'classic' });
  }
};
