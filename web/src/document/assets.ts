import { digestOf } from './digest';

/**
 * Every file that was opened, by SHA-256: the document names them, the session includes them. Files stay where they are, on the disk
 * or in the browser's storage, and are read when they are needed.
 */
export interface Asset {
  readonly name: string;
  readonly sha256: string;
  readonly blob: Blob;
}

export class Assets {
  readonly #byDigest = new Map<string, Asset>();
  readonly #unchecked = new Set<Asset>();

  async add(name: string, blob: Blob): Promise<Asset> {
    const sha256 = await digestOf(new Uint8Array(await blob.arrayBuffer()));
    const known = this.#byDigest.get(sha256);
    // One that came back from the browser's storage goes when the browser clears that: then this is its only copy.
    if (known && !this.#unchecked.has(known) && (await isReadable(known.blob))) return known;
    const asset = { name, sha256, blob };
    this.#byDigest.set(sha256, asset);
    return asset;
  }

  /** One that was kept under its digest before: whether it is that file still, is looked at when it is first read. */
  keep(asset: Asset): void {
    if (this.#byDigest.has(asset.sha256)) return;
    this.#byDigest.set(asset.sha256, asset);
    this.#unchecked.add(asset);
  }

  get(sha256: string): Asset | undefined {
    return this.#byDigest.get(sha256);
  }

  /** True where it is the file of its digest. */
  async check(asset: Asset): Promise<boolean> {
    if (!this.#unchecked.has(asset)) return true;
    const bytes = new Uint8Array(await asset.blob.arrayBuffer());
    if ((await digestOf(bytes)) !== asset.sha256) return false;
    this.#unchecked.delete(asset);
    return true;
  }
}

/**
 * Are its bytes still there? Those of a file on the disk may be moved away, those of one in the browser's storage cleared. Of a part
 * Chromium says so; who reads all of what was cleared there waits in vain.
 */
export function isReadable(blob: Blob): Promise<boolean> {
  return blob.slice(0, 1).arrayBuffer().then(() => true, () => false);
}
