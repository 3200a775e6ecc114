import type { Services } from '../jobs/services';
import type { FileKind } from '../workers/protocol/decode';
import { bytesOf, type Incoming } from './incoming';

export interface Recognised extends Incoming {
  readonly kind: FileKind;
  /** How it begins. */
  readonly head: Uint8Array<ArrayBuffer>;
}

/** So much of it is kept: an image's size stands there, bytes. */
const HEAD = 64;

/** A file is told by so much of its beginning and its length, bytes (`SNIFFED` in `wasm/decode/src/sniff.rs`). */
const SNIFFED = 1 << 16;

export async function recognise({ decoder }: Services, file: Incoming): Promise<Recognised> {
  const { blob, name } = file;
  const read = await bytesOf(blob.slice(0, SNIFFED));
  const head = read.slice(0, HEAD);
  return { ...file, head, kind: await decoder.call('sniff', { head: read, length: blob.size, name }, { transfer: [read.buffer] }) };
}
