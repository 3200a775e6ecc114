/** Gets a WASM file: what the generated code takes. A browser fetches; Node.js, which cannot, reads the disk. */
let reader: (address: URL) => URL | Promise<Uint8Array<ArrayBuffer>> = (address) => address;

export function readWith(other: typeof reader): void {
  reader = other;
}

export function read(address: URL): URL | Promise<Uint8Array<ArrayBuffer>> {
  return reader(address);
}
