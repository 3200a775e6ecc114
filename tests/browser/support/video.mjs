/** Videos that a browser made, and films that the page wrote, played by a browser that knows nothing of the page. */
import { decode } from 'fast-png';
import { openWindow } from './browser.mjs';

/**
 * The pictures of a film that show for as long as each other.
 *
 * @param {import('./files.mjs').FileToOpen} film
 * @param {number} count
 */
export async function picturesOf({ name, buffer }, count) {
  const page = await openWindow();
  const address = `data:video/${name.split('.').at(-1)};base64,${buffer.toString('base64')}`;
  try {
    const pictures = await page.evaluate(drawn, { address, count });
    return pictures.map((picture) => decode(Buffer.from(picture.split(',')[1], 'base64')));
  } finally {
    await page.context().close();
  }
}

/** Runs in the page. @param {{ address: string, count: number }} film */
async function drawn({ address, count }) {
  const video = document.createElement('video');
  // What is sought is said to be there before it is painted: on a busy machine much later. A picture that stays is painted no more.
  let paintedAt = NaN;
  const onPainted = (/** @type {number} */ _, /** @type {{ mediaTime: number }} */ { mediaTime }) => {
    paintedAt = mediaTime;
    video.requestVideoFrameCallback(onPainted);
  };
  video.requestVideoFrameCallback(onPainted);
  const mostScreenFrames = 1000;
  const painted = async (/** @type {number} */ index) => {
    for (let frames = 0; frames < mostScreenFrames && Math.round((paintedAt * count) / video.duration) !== index; frames++) {
      await new Promise((go) => requestAnimationFrame(go));
    }
  };
  await new Promise((go, stop) => {
    video.onloadeddata = go;
    video.onerror = () => stop(new Error(video.error?.message));
    video.src = address;
  });
  const canvas = document.createElement('canvas');
  Object.assign(canvas, { width: video.videoWidth, height: video.videoHeight });
  const pictures = [];
  for (let index = 0; index < count; index++) {
    const seen = new Promise((go) => (video.onseeked = go));
    video.currentTime = ((index + 0.5) / count) * video.duration;
    await seen;
    await painted(index);
    canvas.getContext('2d')?.drawImage(video, 0, 0);
    pictures.push(canvas.toDataURL());
  }
  return pictures;
}

/**
 * A WebM of frames of one grey each, with neither a duration nor an index, as recorders of browsers leave it: but theirs has what a busy machine got around to.
 *
 * @param {import('playwright-core').Page} page
 * @param {{ levels: readonly number[], width: number, height: number, milliseconds: number }} wanted `milliseconds`: how long each is shown
 */
export async function webmOf(page, wanted) {
  const { width, height, milliseconds } = wanted;
  const pictures = await page.evaluate(encoded, wanted);
  const blocks = pictures.map((picture, index) => {
    const head = Buffer.from([0x81, 0, 0, 0x80]);
    head.writeInt16BE(index * milliseconds, 1);
    return element('a3', head, Buffer.from(picture, 'base64'));
  });
  const video = element('e0', element('b0', number(width)), element('ba', number(height)));
  const track = element('ae', element('d7', number(1)), element('73c5', number(1)), element('83', number(1)), element('86', Buffer.from('V_VP8')), video);
  return Buffer.concat([
    element('1a45dfa3', element('4282', Buffer.from('webm')), element('4287', number(4)), element('4285', number(2))),
    endless('18538067'),
    element('1549a966', element('2ad7b1', number(1_000_000))),
    element('1654ae6b', track),
    endless('1f43b675'),
    element('e7', number(0)),
    ...blocks,
  ]);
}

/** Runs in the page: each a key frame of VP8, base64. @param {Parameters<typeof webmOf>[1]} wanted @returns {Promise<string[]>} */
async function encoded({ levels, width, height, milliseconds }) {
  /** @type {string[]} */
  const pictures = [];
  const output = (/** @type {EncodedVideoChunk} */ chunk) => {
    const bytes = new Uint8Array(chunk.byteLength);
    chunk.copyTo(bytes);
    pictures.push(btoa(String.fromCharCode(...bytes)));
  };
  const encoder = new VideoEncoder({ output, error: (error) => console.error(error) });
  encoder.configure({ codec: 'vp8', width, height, bitrate: 4_000_000 });
  for (const [index, level] of levels.entries()) {
    // Luma is between 16 and 235, and grey has no chroma.
    const planes = new Uint8Array((3 * width * height) / 2).fill(128).fill(Math.round(16 + (level * 219) / 255), 0, width * height);
    const frame = new VideoFrame(planes, { format: 'I420', codedWidth: width, codedHeight: height, timestamp: index * milliseconds * 1000 });
    encoder.encode(frame, { keyFrame: true });
    frame.close();
  }
  await encoder.flush();
  encoder.close();
  return pictures;
}

/** An element of EBML (RFC 8794), its length in eight bytes. @param {string} id hexadecimal @param {...Buffer} content */
function element(id, ...content) {
  const body = Buffer.concat(content);
  const length = Buffer.alloc(8);
  length.writeBigUInt64BE((1n << 56n) | BigInt(body.length));
  return Buffer.concat([Buffer.from(id, 'hex'), length, body]);
}

/** One that goes on to the end. @param {string} id */
function endless(id) {
  return Buffer.concat([Buffer.from(id, 'hex'), Buffer.from('01ffffffffffffff', 'hex')]);
}

/** @param {number} value */
function number(value) {
  const bytes = Buffer.alloc(4);
  bytes.writeUInt32BE(value);
  return bytes;
}
