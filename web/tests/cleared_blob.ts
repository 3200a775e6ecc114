/** Bytes that were in the browser's storage alone, after it was cleared: in Chromium a part of them is refused, and all of them never come. */
export class ClearedBlob extends Blob {
  override slice(): Blob {
    return Object.assign(new Blob(), { arrayBuffer: () => Promise.reject(new DOMException('could not be read', 'NotReadableError')) });
  }

  override arrayBuffer(): Promise<ArrayBuffer> {
    return new Promise(() => undefined);
  }
}
