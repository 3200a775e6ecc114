import { Zip, ZipPassThrough } from 'fflate';
import { BufferTarget, CanvasSource, getFirstEncodableVideoCodec, Mp4OutputFormat, Output, QUALITY_HIGH, WebMOutputFormat } from 'mediabunny';
import type { FilmType, OverlayFrame, OverlayProtocol } from '../protocol/overlay';
import { OverlayDrawing } from './overlay_drawing';
import { OverlayFrames } from './overlay_frames';
import { serve } from './serve';

/** Draws the frames of a film with what was found in them, and writes them as a film or as pictures. */
interface Writer {
  add(drawing: OverlayDrawing, index: number): Promise<void>;
  finish(): Promise<Blob>;
}

let frames: OverlayFrames | null = null;
let open: { readonly drawing: OverlayDrawing; readonly writer: Writer } | null = null;

serve<OverlayProtocol>({
  type: async (look) => (await encodable(new OverlayDrawing(look)))?.type ?? null,
  models: async (models) => {
    frames = await OverlayFrames.open(models);
    return null;
  },
  begin: async ({ look, form }) => {
    open = null;
    const drawing = new OverlayDrawing(look);
    open = { drawing, writer: form === 'pictures' ? pictures() : await film(drawing, look.rate) };
    return null;
  },
  add: async (frame) => {
    const { drawing, writer } = working();
    draw(drawing, frame);
    await writer.add(drawing, frame.index);
    return null;
  },
  finish: async () => {
    const { writer } = working();
    open = null;
    return await writer.finish();
  },
  still: ({ look, frame }) => {
    const drawing = new OverlayDrawing(look);
    draw(drawing, frame);
    return drawing.canvas.convertToBlob({ type: 'image/png' });
  },
});

function working(): NonNullable<typeof open> {
  if (!open) throw new Error('no film was begun');
  return open;
}

function draw(drawing: OverlayDrawing, frame: OverlayFrame): void {
  if (!frames) throw new Error('no models were brought');
  drawing.draw(frame, frames.shown(frame));
}

/** MP4 with H.264 is what every player and slide program shows; what a browser cannot write goes into WebM. */
async function encodable({ canvas: { width, height } }: OverlayDrawing) {
  if (typeof VideoEncoder === 'undefined') return null;
  const mp4 = await getFirstEncodableVideoCodec(['avc'], { width, height });
  if (mp4) return { type: 'mp4' as FilmType, codec: mp4, format: new Mp4OutputFormat() };
  const webm = await getFirstEncodableVideoCodec(['vp9', 'vp8'], { width, height });
  return webm && { type: 'webm' as FilmType, codec: webm, format: new WebMOutputFormat() };
}

async function film(drawing: OverlayDrawing, rate: number): Promise<Writer> {
  const way = await encodable(drawing);
  if (!way) throw new Error('This browser cannot write films: save pictures instead');
  const target = new BufferTarget();
  const output = new Output({ format: way.format, target });
  const source = new CanvasSource(drawing.canvas, { codec: way.codec, bitrate: QUALITY_HIGH });
  output.addVideoTrack(source, { frameRate: rate });
  await output.start();
  let count = 0;
  return {
    add: async () => source.add(count++ / rate, 1 / rate),
    finish: async () => {
      await output.finalize();
      return new Blob([target.buffer ?? new ArrayBuffer()], { type: `video/${way.type}` });
    },
  };
}

/** Named by the frames' numbers in the film, from 1. */
function pictures(): Writer {
  const parts: BlobPart[] = [];
  const zip = new Zip((error, chunk) => {
    if (error) throw error;
    parts.push(chunk as Uint8Array<ArrayBuffer>);
  });
  return {
    add: async ({ canvas }, index) => {
      const png = await canvas.convertToBlob({ type: 'image/png' });
      const file = new ZipPassThrough(`frame_${String(index + 1).padStart(4, '0')}.png`);
      zip.add(file);
      file.push(new Uint8Array(await png.arrayBuffer()), true);
    },
    finish: async () => {
      zip.end();
      return new Blob(parts, { type: 'application/zip' });
    },
  };
}
