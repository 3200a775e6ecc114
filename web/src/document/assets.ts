import { digestOf } from './digest';

/** Bytes of every file that was opened, by SHA-256: the document names them, the session includes them. */
export interface Asset {
  readonly name: string;
  readonly sha256: string;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

export class Assets {
  readonly #byDigest = new Map<string, Asset>();

  async add(name: string, bytes: Uint8Array<ArrayBuffer>): Promise<Asset> {
    const sha256 = await digestOf(bytes);
    const known = this.#byDigest.get(sha256);
    if (known) return known;
    const asset = { name, sha256, bytes };
    this.#byDigest.set(sha256, asset);
    return asset;
  }

  get(sha256: string): Asset | undefined {
    return this.#byDigest.get(sha256);
  }
}
