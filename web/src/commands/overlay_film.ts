import { COMPONENT_COLOURS } from '../controls/colours';
import { distortionKey, fits, numbersOf } from '../document/distortion';
import { checkState, markOf } from '../document/marks';
import { cellOf, chosenCandidate, type Doc } from '../document/types';
import { asJob, type Services } from '../jobs/services';
import type { JointNumbers } from '../results/joint_curves';
import { cameraOf } from '../results/keys';
import { doubtOf } from '../results/motion';
import { asWritten } from '../results/outdated';
import { COMPONENT_NAMES, titleOf } from '../terms/component';
import type { Preprocessing } from '../terms/seeing';
import { formatNumber } from '../texts/numbers';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import { overlayWorker } from '../workers/start';
import type { FilmType, OverlayCurve, OverlayFrame, OverlayLook } from '../workers/protocol/overlay';

/** Pictures a second where nobody said how fast the film was taken. */
export const USUAL_RATE = 10;

/** Colours of the curves beside the film, on dark: what the page's style has for medial and lateral. */
const LINES = { only: '#d8dbde', medial: '#2fc79f', lateral: '#e28fd0' } as const;

export function overlayLook(doc: Doc, numbers: JointNumbers): OverlayLook | null {
  const first = doc.frames[0];
  if (!first) return null;
  const { name, rate, frames } = doc;
  const curves = numbers.of.size > 0 ? curvesOf(doc, numbers) : [];
  return { name, width: first.width, height: first.height, frames: frames.length, rate: rate ?? USUAL_RATE, curves, noCurves: later.exporting.film.noCurves };
}

/** As the published figure has them; without a tray what the poses alone tell. */
function curvesOf({ frames }: Doc, { of, impossible, columns, hasPlate }: JointNumbers): OverlayCurve[] {
  const { curves, of: sides } = later.curves;
  const line = (column: string, colour: string, label: string) => {
    const over = (name: string) => Float64Array.from(frames, ({ id }) => (impossible.has(id) ? NaN : (of.get(id)?.[columns.indexOf(name)] ?? NaN)));
    return { colour, label, values: over(column), deviations: over(`sd_${column}`) };
  };
  const one = (title: string, unit: string, column: string): OverlayCurve => ({ title, unit, lines: [line(column, LINES.only, '')] });
  const both = { title: curves.lowest.title, unit: 'mm', lines: [line('medial_ap_mm', LINES.medial, sides.medial), line('lateral_ap_mm', LINES.lateral, sides.lateral)] };
  return [
    one(curves.flexion.title, '\u00b0', 'flexion_deg'),
    one(curves.internal.title, '\u00b0', 'internal_rotation_deg'),
    ...(hasPlate ? [both, one(curves.liftOff.title, 'mm', 'lift_off_mm')] : [one(curves.abduction.title, '\u00b0', 'abduction_deg'), one(curves.anterior.title, 'mm', 'field_anterior_mm')]),
  ];
}

/** What a film of overlays is made of. */
interface Shown {
  readonly doc: Doc;
  readonly preprocessing: Preprocessing;
}

/** Pictures of the film with the outlines of the models at their poses. A worker paints and writes them; here they are only named. */
export class OverlayPictures {
  readonly #services: Services;
  readonly #worker = overlayWorker();
  /** Models that the worker has. */
  #models: string | null = null;

  constructor(services: Services) {
    this.#services = services;
  }

  /** Which film this browser can write. */
  type(look: OverlayLook): Promise<FilmType | null> {
    return this.#worker.call('type', { ...look, curves: [] });
  }

  /** One frame, as PNG. */
  async still(look: OverlayLook, index: number): Promise<Blob> {
    await this.#bringModels();
    const frame = await this.#frame(this.#shown(), index, new AbortController().signal);
    return await this.#worker.call('still', { look, frame }, { transfer: [frame.frame.pixels.buffer] });
  }

  /** All of them. */
  async write(look: OverlayLook, form: FilmType | 'pictures', signal: AbortSignal, report: (done: number, total: number) => void): Promise<Blob> {
    const shown = this.#shown();
    await this.#bringModels();
    await this.#worker.call('begin', { look, form }, { signal });
    // What is done to the poses while it is written is of another film.
    let coming = this.#coming(shown, 0, signal);
    for (let index = 0; index < look.frames; index++) {
      const frame = await coming;
      // The next one is read while this one is drawn.
      coming = this.#coming(shown, index + 1, signal);
      await this.#worker.call('add', frame!, { signal, transfer: [frame!.frame.pixels.buffer] });
      report(index + 1, look.frames);
    }
    return await this.#worker.call('finish', null, { signal });
  }

  dispose(): void {
    this.#worker.dispose();
  }

  async #bringModels(): Promise<void> {
    const { store, studio } = this.#services;
    const models = COMPONENT_NAMES.flatMap((component) => {
      const { model } = store.doc.components[component];
      const mesh = model && studio.meshOf(model.sha256);
      return mesh ? [{ component, colour: COMPONENT_COLOURS[component].css, mesh, sha256: model.sha256 }] : [];
    });
    const key = models.map(({ component, sha256 }) => `${component} ${sha256}`).join();
    if (key === this.#models) return;
    await this.#worker.call('models', models);
    this.#models = key;
  }

  #shown(): Shown {
    const { doc, ui } = this.#services.store;
    return { doc: asWritten(doc), preprocessing: ui.seeing.preprocessing };
  }

  #coming(shown: Shown, index: number, signal: AbortSignal): Promise<OverlayFrame | null> {
    const coming = index < shown.doc.frames.length ? this.#frame(shown, index, signal) : Promise.resolve(null);
    // Whoever waits for it hears of it; nobody does where the one before it fails.
    coming.catch(() => null);
    return coming;
  }

  async #frame({ doc, preprocessing }: Shown, index: number, signal: AbortSignal): Promise<OverlayFrame> {
    const { studio } = this.#services;
    const entry = doc.frames[index];
    const frame = entry ? await studio.decoded(entry.id, signal) : null;
    if (!entry || !frame) throw new Error(later.exporting.film.absent(index + 1));
    const { heading, time } = later.exporting.film;
    const { distortion } = doc;
    return {
      index,
      frame,
      window: doc.window,
      preprocessing,
      undistorted: distortion?.appliesTo === 'frames' && fits(distortion, frame) ? { key: distortionKey(distortion), numbers: numbersOf(distortion) } : null,
      camera: cameraOf(doc, entry),
      poses: COMPONENT_NAMES.flatMap((component) => {
        const candidate = chosenCandidate(cellOf(doc, entry.id, component));
        return candidate ? [{ component, pose: candidate.pose }] : [];
      }),
      heading: heading(index + 1, doc.frames.length),
      time: doc.rate === null ? '' : time(formatNumber(index / doc.rate, 2)),
      notes: notesOn(doc, index),
    };
  }
}

/** What is missing or doubtful, so that nobody takes a picture for more than it is; of what a person has accepted, that it was. */
export function notesOn(doc: Doc, index: number): string[] {
  const { none, doubtful, accepted } = later.exporting.film;
  const frameId = doc.frames[index]?.id;
  if (frameId === undefined) return [];
  return COMPONENT_NAMES.flatMap((component) => {
    const cell = cellOf(doc, frameId, component);
    const title = titleOf(component);
    if (!chosenCandidate(cell)) return [none(title)];
    const doubt = doubtOf(cell);
    if (doubt === null) return [];
    const isAccepted = checkState(cell, markOf(doc, { frameId, component })) === 'yes';
    return [isAccepted ? accepted(title, texts.follow.accepted(doubt)) : doubtful(title, doubt)];
  });
}

/** Writes all frames. It stands among the page's jobs, and can be called off; then nothing is written. */
export async function writeOverlayFilm(services: Services, look: OverlayLook, form: FilmType | 'pictures'): Promise<Blob> {
  const pictures = new OverlayPictures(services);
  const { title, unit } = later.exporting.film;
  const abort = new AbortController();
  const job = { title, unit, total: look.frames, cancel: () => abort.abort() };
  try {
    return await asJob(services.store, job, (report) => pictures.write(look, form, abort.signal, report));
  } finally {
    pictures.dispose();
  }
}
