import { BlobSource, EncodedPacketSink, Input, MATROSKA, MP4, QTFF, WEBM } from 'mediabunny';

/** Seconds at which the pictures of a video begin, as its file has them, in their order; none where the file is not understood. */
export async function pictureTimes(blob: Blob, signal: AbortSignal): Promise<readonly number[]> {
  const times: number[] = [];
  const input = new Input({ formats: [MP4, QTFF, WEBM, MATROSKA], source: new BlobSource(blob) });
  try {
    const track = await input.getPrimaryVideoTrack();
    if (!track) return [];
    // Of what is coded from pictures to come it is not the order in the file.
    for await (const { timestamp } of new EncodedPacketSink(track).packets(undefined, undefined, { metadataOnly: true })) {
      signal.throwIfAborted();
      times.push(timestamp);
    }
  } catch {
    signal.throwIfAborted();
    return [];
  } finally {
    input.dispose();
  }
  return times.sort((a, b) => a - b);
}
