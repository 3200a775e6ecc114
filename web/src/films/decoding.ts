import { isReadable, type Assets } from '../document/assets';
import { texts } from '../texts/texts';
import { work } from '../workers/activity';
import type { Bridge } from '../workers/bridge';
import type { DecodedFrame, DecodeProtocol } from '../workers/protocol/decode';

/** Where a frame can be had from. */
export interface FrameSource {
  /** SHA-256 of the file that holds it. */
  readonly sha256: string;
  readonly index: number;
}

/** Decodes a frame of a file that is at hand; null where it is not. */
export type DecodeFrame = (source: FrameSource, signal: AbortSignal) => Promise<DecodedFrame | null>;

/** By a worker of its own: what somebody looks at does not wait for files that are being opened. */
export function frameDecoder(assets: Assets, worker: Pick<Bridge<DecodeProtocol>, 'call'>): DecodeFrame {
  return async ({ sha256, index }, signal) => {
    const asset = assets.get(sha256);
    if (!asset) return null;
    const { name, blob } = asset;
    const over = work.begin();
    try {
      if (!(await isReadable(blob))) throw new Error(texts.keep.filesGone(name));
      if (!(await assets.check(asset))) throw new Error(texts.keep.damaged(name));
      return await worker.call('frame', { key: sha256, blob, name, index }, { signal });
    } finally {
      over();
    }
  };
}
