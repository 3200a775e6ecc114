import type { ComponentName } from '../terms/component';

/** A file as it came, from a button, a drop or an address. It is read when it is needed, and no sooner. */
export interface Incoming {
  readonly name: string;
  readonly blob: Blob;
  /** With its folders, where the browser tells. */
  readonly path?: string;
  /** Where the person said what it is for. */
  readonly component?: ComponentName | undefined;
}

/** All of a file as text. */
export async function textOf({ blob }: Pick<Incoming, 'blob'>): Promise<string> {
  return new TextDecoder().decode(await bytesOf(blob));
}

export async function bytesOf(blob: Blob): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array(await blob.arrayBuffer());
}
