import { texts } from '../texts/texts';
import { greyPng } from './grey_png';

const said = texts.files.video;

/** A video that the browser shows, a picture at a time. */
export interface Video {
  readonly name: string;
  readonly width: number;
  readonly height: number;
  /** Seconds. */
  readonly duration: number;
  /** Pictures a second, by the least time that one is shown. */
  readonly rate: number;
  readonly element: HTMLVideoElement;
  close(): void;
}

export interface TakenFrame {
  readonly name: string;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

/** Pictures looked at to measure the rate: it is the least step that occurs among them. */
const MEASURED = 12;
/** Longer than this there is no waiting for pictures when the rate is measured, ms. */
const PATIENCE = 4000;
const USUAL_RATE = 25;

/** Opens a video. Throws a sentence for what the browser cannot decode. */
export async function openVideo(name: string, blob: Blob, signal: AbortSignal): Promise<Video> {
  const address = URL.createObjectURL(new Blob([blob], { type: typeOf(name) }));
  const element = document.createElement('video');
  const close = () => {
    element.removeAttribute('src');
    element.load();
    URL.revokeObjectURL(address);
  };
  try {
    element.muted = true;
    element.playsInline = true;
    element.preload = 'auto';
    element.src = address;
    await heard(element, 'loadeddata', signal, said.cannot(name));
    const { videoWidth: width, videoHeight: height } = element;
    if (width === 0 || height === 0) throw new Error(said.noSize(name));
    const end = await durationOf(element, signal);
    const rate = await rateOf(element, blob, signal);
    // Recorders may end a video with the beginning of its last picture: that one lasts a while, too.
    const last = await seek(element, end, signal);
    const duration = Math.max(end, (last ?? 0) + 1 / rate);
    await seek(element, 0, signal);
    return { name, width, height, duration, rate, element, close };
  } catch (error) {
    close();
    throw error;
  }
}

/** The browser looks at the content all the same; the type only lets it begin. */
function typeOf(name: string): string {
  if (/\.(webm|mkv)$/i.test(name)) return 'video/webm';
  return /\.(mp4|m4v|mov)$/i.test(name) ? 'video/mp4' : '';
}

function heard(element: HTMLVideoElement, event: string, signal: AbortSignal, sentence: string): Promise<void> {
  return new Promise((resolve, reject) => {
    const stop = new AbortController();
    const end = (settle: () => void) => {
      stop.abort();
      settle();
    };
    element.addEventListener(event, () => end(resolve), { signal: stop.signal });
    element.addEventListener('error', () => end(() => reject(new Error(sentence))), { signal: stop.signal });
    signal.addEventListener('abort', () => end(() => reject(signal.reason)), { signal: stop.signal });
    if (signal.aborted) end(() => reject(signal.reason));
  });
}

/** Recordings of browsers do not state how long they are: a place far beyond tells. */
async function durationOf(element: HTMLVideoElement, signal: AbortSignal): Promise<number> {
  if (Number.isFinite(element.duration)) return element.duration;
  element.currentTime = 1e9;
  await heard(element, 'seeked', signal, said.cannot(''));
  return Number.isFinite(element.duration) ? element.duration : element.currentTime;
}

/** Goes to a time and returns that of the picture that is shown then, seconds; null where the browser does not tell. */
async function seek(element: HTMLVideoElement, time: number, signal: AbortSignal): Promise<number | null> {
  const { shown, forget } = nextPicture(element);
  element.currentTime = time;
  try {
    await heard(element, 'seeked', signal, said.cannot(''));
    return await Promise.race([shown, noOtherPicture()]);
  } finally {
    forget();
  }
}

/** The time of the next picture that is shown. A page that nobody sees shows none. */
function nextPicture(element: HTMLVideoElement): { readonly shown: Promise<number | null>; readonly forget: () => void } {
  if (!('requestVideoFrameCallback' in element)) return { shown: Promise.resolve(null), forget: () => undefined };
  let id = 0;
  const shown = new Promise<number>((resolve) => {
    id = element.requestVideoFrameCallback((_, { mediaTime }) => resolve(mediaTime));
  });
  return { shown, forget: () => element.cancelVideoFrameCallback(id) };
}

/** So long after a seek no other picture is to be expected: ms, and then so many screen frames, for a busy machine shows few of them. */
const SAME_PICTURE = { milliseconds: 250, frames: 5 };

async function noOtherPicture(): Promise<null> {
  await after(SAME_PICTURE.milliseconds);
  for (let frame = 0; frame < SAME_PICTURE.frames; frame++) {
    // A page that nobody sees has no screen frames.
    await Promise.race([new Promise((resolve) => requestAnimationFrame(resolve)), after(SAME_PICTURE.milliseconds)]);
  }
  return null;
}

function after(milliseconds: number): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, milliseconds));
}

/** By the file's own times of its pictures, else as the beginning plays. */
async function rateOf(element: HTMLVideoElement, blob: Blob, signal: AbortSignal): Promise<number> {
  const times = await (await import('./picture_times')).pictureTimes(blob, signal);
  return times.length > 1 ? rateFrom(times) : playedRate(element, signal);
}

/** Plays the beginning and takes the least step between pictures: a busy machine leaves some out, none come too early. */
async function playedRate(element: HTMLVideoElement, signal: AbortSignal): Promise<number> {
  if (!('requestVideoFrameCallback' in element)) return USUAL_RATE;
  await seek(element, 0, signal);
  const times: number[] = [];
  await new Promise<void>((resolve) => {
    const timer = setTimeout(resolve, PATIENCE);
    const end = () => {
      clearTimeout(timer);
      resolve();
    };
    const next: VideoFrameRequestCallback = (_, { mediaTime }) => {
      times.push(mediaTime);
      if (times.length >= MEASURED || signal.aborted) end();
      else element.requestVideoFrameCallback(next);
    };
    element.requestVideoFrameCallback(next);
    element.addEventListener('ended', end, { once: true });
    element.play().catch(end);
  });
  element.pause();
  signal.throwIfAborted();
  return rateFrom(times);
}

/** Of times in some files, s. */
const ROUNDING = 0.0015;

/** Pictures a second from the times of some. */
export function rateFrom(times: readonly number[]): number {
  const steps = times.slice(1).map((time, at) => time - (times[at] ?? 0)).filter((step) => step > 1e-3);
  if (steps.length === 0) return USUAL_RATE;
  // Times may be rounded to milliseconds: the mean of the steps near the least is better than the least. Where pictures
  // come as they like no step between the times that are looked at may be longer than the least.
  const least = Math.min(...steps);
  const single = steps.filter((step) => step < 1.05 * least + ROUNDING);
  return single.length / single.reduce((sum, step) => sum + step, 0);
}

/** Which pictures are wanted: seconds from and to, and every so many. */
export interface PictureChoice {
  readonly from: number;
  readonly to: number;
  readonly every: number;
}

/** Times in the middle of the chosen pictures, seconds. */
export function timesOf({ duration, rate }: Pick<Video, 'duration' | 'rate'>, { from, to, every }: PictureChoice): number[] {
  const step = Math.max(1, Math.round(every)) / rate;
  const first = Math.max(0, Math.round(from * rate)) / rate;
  const end = Math.min(to, duration);
  if (!(end > first) || !Number.isFinite(step)) return [];
  const count = Math.max(1, Math.ceil((end - first) / step - 1e-6));
  return Array.from({ length: count }, (_, at) => first + at * step + 0.5 / rate).filter((time) => time < duration + 0.5 / rate);
}

export interface Taking {
  readonly signal: AbortSignal;
  readonly onFrame: (frame: TakenFrame, done: number, total: number) => void;
}

/** Takes the pictures one by one as grey images; one that was taken before is left out. Returns how many were. */
export async function takeFrames(video: Video, choice: PictureChoice, { signal, onFrame }: Taking): Promise<number> {
  const times = timesOf(video, choice);
  const canvas = new OffscreenCanvas(video.width, video.height);
  const context = canvas.getContext('2d', { willReadFrequently: true });
  if (!context) throw new Error('this browser has no 2-D canvas');
  const stem = video.name.replace(/\.[a-z0-9]+$/i, '');
  const digits = String(times.length).length;
  let repeated = 0;
  let last: TakenPicture | null = null;
  for (const [index, time] of times.entries()) {
    signal.throwIfAborted();
    const shown = await seek(video.element, Math.min(time, video.duration), signal);
    context.drawImage(video.element, 0, 0);
    const { data } = context.getImageData(0, 0, video.width, video.height);
    const bytes = await greyPng(data, video.width, video.height);
    const picture = { shown, bytes };
    if (last && isSame(last, picture)) {
      repeated++;
      continue;
    }
    last = picture;
    const name = said.frameName(stem, String(index + 1).padStart(digits, '0'), (shown ?? time).toFixed(3));
    onFrame({ name, bytes }, index + 1, times.length);
  }
  return repeated;
}

interface TakenPicture {
  readonly shown: number | null;
  readonly bytes: Uint8Array<ArrayBuffer>;
}

/** By its time in the video; where the browser does not tell, by its pixels. */
function isSame(a: TakenPicture, b: TakenPicture): boolean {
  if (a.shown !== null && b.shown !== null) return a.shown === b.shown;
  return a.bytes.length === b.bytes.length && a.bytes.every((value, at) => value === b.bytes[at]);
}
