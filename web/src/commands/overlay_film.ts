import { COMPONENT_COLOURS } from '../controls/colours';
import { cellOf, chosenCandidate, type Doc } from '../document/types';
import { asJob, type Services } from '../jobs/services';
import type { JointNumbers } from '../results/joint_curves';
import { cameraOf } from '../results/keys';
import { doubtOf } from '../results/motion';
import { COMPONENT_NAMES, type ComponentName, titleOf } from '../terms/component';
import { formatNumber } from '../texts/numbers';
import { later } from '../texts/later';
import type { Bridge } from '../workers/bridge';
import { overlayWorker } from '../workers/start';
import type { FilmType, OverlayCurve, OverlayFrame, OverlayLook, OverlayProtocol } from '../workers/protocol/overlay';

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

/** Frames of the film with the outlines of the models at their poses, one after the other, for a worker. */
export class OverlayFrames {
  readonly #services: Services;
  readonly #canvas = document.createElement('canvas');
  readonly #spare = document.createElement('canvas');

  constructor(services: Services) {
    this.#services = services;
  }

  async frame(index: number): Promise<OverlayFrame> {
    const { studio, store } = this.#services;
    const { doc, ui } = store;
    const frame = doc.frames[index];
    const facts = frame && studio.frameFacts(frame.id);
    if (!frame || !facts) throw new Error(later.exporting.film.absent(index + 1));
    this.#canvas.width = this.#spare.width = frame.width;
    this.#canvas.height = this.#spare.height = frame.height;
    studio.paintFrame(contextOf(this.#canvas), frame.id, doc.window ?? facts.window, ui.seeing.preprocessing);
    const { heading, time } = later.exporting.film;
    return {
      index,
      picture: await createImageBitmap(this.#canvas),
      outlines: COMPONENT_NAMES.flatMap((component) => {
        const corners = this.#corners(doc, index, component);
        return corners ? [{ colour: COMPONENT_COLOURS[component].css, corners }] : [];
      }),
      heading: heading(index + 1, doc.frames.length),
      time: doc.rate === null ? '' : time(formatNumber(index / doc.rate, 2)),
      notes: notesOn(doc, index),
    };
  }

  #corners(doc: Doc, index: number, component: ComponentName): Float64Array<ArrayBuffer> | null {
    const frame = doc.frames[index] ?? null;
    const { model } = doc.components[component];
    const candidate = chosenCandidate(cellOf(doc, frame?.id, component));
    const camera = cameraOf(doc, frame);
    if (!model || !candidate || !camera) return null;
    const painted = this.#services.studio.paintSilhouette(() => contextOf(this.#spare), model.sha256, camera, candidate.pose, COMPONENT_COLOURS[component].rgb);
    return painted && Float64Array.from(painted.border);
  }
}

/** What is missing or doubtful, so that nobody takes a picture for more than it is. */
function notesOn(doc: Doc, index: number): string[] {
  const { none, doubtful } = later.exporting.film;
  return COMPONENT_NAMES.flatMap((component) => {
    const cell = cellOf(doc, doc.frames[index]?.id, component);
    const title = titleOf(component);
    if (!chosenCandidate(cell)) return [none(title)];
    const doubt = doubtOf(cell);
    return doubt === null ? [] : [doubtful(title, doubt)];
  });
}

function contextOf(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  const context = canvas.getContext('2d');
  if (!context) throw new Error('this browser has no 2-D canvas');
  return context;
}

/** Writes all frames. It stands among the page's jobs, and can be called off; then nothing is written. */
export async function writeOverlayFilm(services: Services, look: OverlayLook, form: FilmType | 'pictures'): Promise<Blob> {
  const worker = overlayWorker();
  const { title, unit } = later.exporting.film;
  const abort = new AbortController();
  const job = { title, unit, total: look.frames, cancel: () => abort.abort() };
  try {
    return await asJob(services.store, job, (report) => allFrames(services, worker, look, form, abort.signal, report));
  } finally {
    worker.dispose();
  }
}

async function allFrames(services: Services, worker: Bridge<OverlayProtocol>, look: OverlayLook, form: FilmType | 'pictures', signal: AbortSignal, report: (done: number, total: number) => void): Promise<Blob> {
  const frames = new OverlayFrames(services);
  await worker.call('begin', { look, form }, { signal });
  for (let index = 0; index < look.frames; index++) {
    const frame = await frames.frame(index);
    await worker.call('add', frame, { signal, transfer: [frame.picture] });
    report(index + 1, look.frames);
  }
  return await worker.call('finish', null, { signal });
}
