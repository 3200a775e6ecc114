import { setRate } from '../document/commands';
import { texts } from '../texts/texts';
import { Aborted } from '../workers/bridge';
import type { Incoming } from './incoming';
import { asJob, sentenceOf, type Services } from '../jobs/services';
import type { PictureChoice, TakenFrame, Video } from './video';

/** Few open one. */
const reader = () => import('./video');

const said = texts.files.video;

/** The video whose pictures are being chosen. What is taken of it goes the way of all image files. */
export class Videos {
  readonly #services: Services;
  readonly #open: (files: readonly Incoming[]) => Promise<boolean>;
  #video: Video | null = null;

  constructor(services: Services, open: (files: readonly Incoming[]) => Promise<boolean>) {
    this.#services = services;
    this.#open = open;
    let shown = false;
    // A sheet that is closed lets its video go.
    services.store.subscribe(() => {
      const before = shown;
      shown = services.store.ui.popover === 'video';
      if (before && !shown) this.#letGo();
    });
  }

  get video(): Video | null {
    return this.#video;
  }

  /** Throws a sentence for what the browser cannot decode. */
  async begin({ name, blob }: Incoming): Promise<void> {
    const { store } = this.#services;
    const abort = new AbortController();
    const job = { title: said.measuring, unit: '', total: 0, cancel: () => abort.abort(new Aborted()) };
    const video = await asJob(store, job, async () => (await reader()).openVideo(name, blob, abort.signal));
    this.#letGo();
    this.#video = video;
    store.show({ popover: 'video' });
  }

  /** Draws the picture at a time. */
  async show(time: number, canvas: HTMLCanvasElement): Promise<void> {
    const video = this.#video;
    if (!video || !Number.isFinite(time)) return;
    const { element } = video;
    const draw = () => canvas.getContext('2d')?.drawImage(element, 0, 0);
    element.addEventListener('seeked', draw, { once: true });
    element.currentTime = Math.min(video.duration, Math.max(0, time + 0.5 / video.rate));
  }

  async take(choice: PictureChoice): Promise<void> {
    const { store } = this.#services;
    const video = this.#video;
    if (!video) return;
    const { doc } = store;
    const abort = new AbortController();
    const taken: TakenFrame[] = [];
    let repeated = 0;
    const job = { title: said.taking, unit: said.unit, total: 0, cancel: () => abort.abort(new Aborted()) };
    // The sheet may be closed meanwhile: the video is let go when all is taken.
    this.#video = null;
    store.show({ popover: null });
    try {
      repeated = await asJob(store, job, async (report) =>
        (await reader()).takeFrames(video, choice, {
          signal: abort.signal,
          onFrame: (frame, done, total) => {
            taken.push(frame);
            report(done, total);
          },
        }),
      );
    } catch (error) {
      if (!(error instanceof Aborted)) store.say('error', `${video.name}: ${sentenceOf(error)}`);
    } finally {
      video.close();
    }
    const isHere = taken.length > 0 && (await this.#open(taken.map(({ name, bytes }) => ({ name, blob: new Blob([bytes]) }))));
    // That is said, and the rate is not of what is on view.
    if (taken.length > 0 && !isHere) return;
    // Frames that were here before may be of another film.
    if (taken.length > 1 && doc.frames.length === 0 && doc.rate === null) store.perform(setRate(video.rate / Math.max(1, Math.round(choice.every))));
    if (abort.signal.aborted) return store.say('info', said.called(taken.length));
    store.say('info', said.taken(taken.length, video.name, repeated === 0 ? said.noneRepeated : said.repeated(repeated)));
  }

  #letGo(): void {
    this.#video?.close();
    this.#video = null;
  }
}
