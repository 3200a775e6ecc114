/** Films that the page wrote, played by a browser that knows nothing of the page. */
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
