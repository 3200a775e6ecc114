import { setCalibration } from '../document/commands';
import { distortionOf, fits, type Distortion } from '../document/distortion';
import { NOTHING_MEASURED, withMark, withMovedMark, withTyped, type MeasuredDistortion, type MeasuredGrid, type Measuring } from '../document/measuring';
import { currentFrame } from '../document/store';
import type { Doc } from '../document/types';
import type { FramePoint } from '../geometry/points';
import { texts } from '../texts/texts';
import { Aborted, type Bridge } from '../workers/bridge';
import type { CalibrateProtocol } from '../workers/protocol/calibrate';
import { asJob, sentenceOf, type Services } from './services';
import { takeDistortion } from './take_distortion';
import { undistorting } from '../films/undistorted';
import { calibrateWorker } from '../workers/start';

const said = texts.calibrate;

/** Looks for beads, and brings what is taken of them into the document. */
export class Calibrator {
  readonly #services: Services;
  #worker: Bridge<CalibrateProtocol> | null = null;

  constructor(services: Services) {
    this.#services = services;
    // The studio shows frames undistorted where the document asks for it, before any view looks.
    services.store.subscribe(() => services.studio.useDistortion(services.store.doc.distortion));
  }

  show(change: Partial<Measuring>): void {
    const { store } = this.#services;
    store.show({ measuring: { ...(store.ui.measuring ?? NOTHING_MEASURED), ...change } });
  }

  /** A press on the frame sets a mark of the ruler; while it is held the mark goes with the pointer. */
  mark(at: FramePoint, begins: boolean): void {
    const { marks } = this.#services.store.ui.measuring ?? NOTHING_MEASURED;
    this.show({ marks: begins ? withMark(marks, at) : withMovedMark(marks, at) });
  }

  /** A number of a mark, typed: the others are those that are there by now, not those on view. */
  type(index: number, typed: Parameters<typeof withTyped>[2]): void {
    const { marks } = this.#services.store.ui.measuring ?? NOTHING_MEASURED;
    this.show({ marks: withTyped(marks, index, typed) });
  }

  /** Beads of the frame on view, as it was taken. */
  async find(radius: number, bright: boolean): Promise<void> {
    const { store, studio } = this.#services;
    const frame = currentFrame(store.state);
    const pixels = frame && (await studio.takenPixels(frame.id));
    if (!frame || !pixels) return store.say('error', said.noFrame);
    this.show({ grid: null });
    const worker = (this.#worker ??= calibrateWorker());
    const abort = new AbortController();
    const cancel = () => {
      abort.abort();
      // The search does not pause to listen: its worker is let go.
      this.#worker?.dispose();
      this.#worker = null;
    };
    const { width, height } = frame;
    try {
      const found = await asJob(store, { title: said.searching, unit: '', total: 0, cancel }, () =>
        worker.call('find', { pixels, width, height, radius, bright }, { signal: abort.signal, transfer: [pixels.buffer] }),
      );
      this.show({ grid: { ...found, frameId: frame.id, frameName: frame.name, width, height } });
      store.say('info', said.found(found.beads.length / 4, found.marks));
    } catch (error) {
      if (!(error instanceof Aborted)) store.say('error', `${frame.name}: ${sentenceOf(error)}`);
    }
  }

  /** Where the beads lie in the frames that poses are worked out in. */
  beadsForCamera(grid: MeasuredGrid, doc: Doc): Float64Array<ArrayBuffer> {
    const { distortion } = doc;
    return fits(distortion, grid) ? this.#moved(grid.beads, undistorting(distortion)) : grid.beads;
  }

  /** Where the beads lie on the frame as it is shown. */
  beadsShown(grid: MeasuredGrid, doc: Doc): Float64Array<ArrayBuffer> {
    return doc.distortion?.appliesTo === 'frames' ? this.beadsForCamera(grid, doc) : grid.beads;
  }

  #moved(beads: Float64Array<ArrayBuffer>, move: (points: Float64Array<ArrayBuffer>) => ArrayLike<number>): Float64Array<ArrayBuffer> {
    const places = move(Float64Array.from({ length: beads.length / 2 }, (_, at) => beads[4 * (at >> 1) + (at & 1)] ?? 0));
    return beads.map((value, at) => (at % 4 < 2 ? (places[2 * (at >> 2) + (at % 4)] ?? value) : value));
  }

  useFit(grid: MeasuredGrid, fit: MeasuredDistortion, appliesTo: Distortion['appliesTo']): void {
    this.use(distortionOf(fit.numbers, { name: grid.frameName, appliesTo, quality: qualityOf(fit) }));
  }

  /** Takes a correction into the document, or takes it away. */
  use(distortion: Distortion | null): void {
    takeDistortion(this.#services, distortion);
  }

  useCamera(name: string, text: string): void {
    const { store } = this.#services;
    store.perform(setCalibration({ name, text }));
    store.say('info', said.calibrated(name));
  }
}

function qualityOf({ quality }: MeasuredDistortion): Distortion['quality'] {
  const [beads = 0, dropped = 0, before = 0, after = 0, three = NaN, four = NaN, five = NaN, largestShift = 0] = quality;
  const leftOut = [three, four, five].map((value) => (Number.isNaN(value) ? null : value));
  return { beads, dropped, before, after, leftOut, largestShift };
}
