import type { Place } from '../document/command';
import { cellOf, chosenCandidate, type FrameEntry } from '../document/types';
import { middleOf } from '../geometry/mesh_middle';
import { type FramePoint, framePoint } from '../geometry/points';
import { inCamera } from '../geometry/pose_motion';
import { cameraOf } from '../results/keys';
import { otherThan, type ComponentName } from '../terms/component';
import { texts } from '../texts/texts';
import type { Bridge } from '../workers/bridge';
import type { Beside, FollowProtocol } from '../workers/protocol/follow';
import type { PoseProtocol } from '../workers/protocol/pose';
import { libraryReady } from './library_ready';
import { asJob, type Services } from './services';

type Worker = Pick<Bridge<FollowProtocol>, 'call'>;

/** In so many frames at most a component is looked for beside the other one. */
const FRAMES = 3;

/** What a click would do. */
export interface Clicks {
  ask(prompt: readonly [FramePoint], place: Place, bright: boolean | null): Promise<void>;
}

/**
 * Finds components that nobody pointed at: their workers look for them in some whole frames, and where one is found it is clicked
 * there, so that its pose is found, judged and corrected as that of any click.
 */
export class FirstPoses {
  readonly #services: Services;
  readonly #poser: Pick<Bridge<PoseProtocol>, 'call'>;
  readonly #clicks: Clicks;

  constructor(services: Services, poser: Pick<Bridge<PoseProtocol>, 'call'>, clicks: Clicks) {
    this.#services = services;
    this.#poser = poser;
    this.#clicks = clicks;
  }

  /** Opens what whole frames are searched with; gives the frames that are worth it, none where there is no library. */
  async open(component: ComponentName, worker: Worker, bright = this.#services.store.ui.tracing.bright ?? false): Promise<readonly number[]> {
    const { store, studio } = this.#services;
    await libraryReady(store, component);
    const { doc, ui } = store;
    const { model } = doc.components[component];
    const mesh = model && studio.meshOf(model.sha256);
    const camera = cameraOf(doc, doc.frames[0] ?? null);
    if (!mesh || !camera || ui.libraries[component].state !== 'ready') return [];
    const library = await this.#poser.call('library', { component });
    const input = { mesh, camera, library, frames: doc.frames.length, bright };
    return worker.call('openSearch', input, { transfer: [library.buffer] });
  }

  /**
   * Looks for a component in the whole of some frames: for dark metal, as a fluoroscope shows it, and then for bright, where nobody
   * has said which. False where it is in none of them.
   */
  async find(component: ComponentName, worker: Worker, signal: AbortSignal, cancel: () => void): Promise<boolean> {
    const { store } = this.#services;
    for (const shown of [false, true]) {
      // The other component may have told meanwhile.
      const isAsShown = (store.ui.tracing.bright ?? shown) === shown;
      if (isAsShown && (await this.#findAs(shown, component, worker, signal, cancel))) return true;
    }
    return false;
  }

  async #findAs(bright: boolean, component: ComponentName, worker: Worker, signal: AbortSignal, cancel: () => void): Promise<boolean> {
    const { store } = this.#services;
    for (const number of await this.open(component, worker, bright)) {
      const frame = store.doc.frames[number];
      if (!frame) continue;
      const place = { frameId: frame.id, component };
      const at = await this.#search(place, number, worker, signal, cancel);
      if (!at) continue;
      await this.#clicks.ask([at], place, bright);
      if (cellOf(store.doc, frame.id, component).result?.kind === 'posed') return true;
    }
    return false;
  }

  /** Looks for a component beside the joint's other one, in frames where that was found. False where it is in none of them. */
  async findBeside(component: ComponentName, worker: Worker, signal: AbortSignal, cancel: () => void): Promise<boolean> {
    const { store } = this.#services;
    const { doc, ui } = store;
    const known = doc.frames.flatMap((frame, number) => {
      const beside = this.#beside(component, frame);
      return beside ? [{ frame, number, beside }] : [];
    });
    if (known.length === 0) return false;
    const bright = ui.tracing.bright ?? false;
    await this.open(component, worker, bright);
    for (const { frame, number, beside } of known.slice(0, FRAMES)) {
      const place = { frameId: frame.id, component };
      const at = await this.#search(place, number, worker, signal, cancel, beside);
      if (!at) continue;
      await this.#clicks.ask([at], place, bright);
      if (cellOf(store.doc, frame.id, component).result?.kind === 'posed') return true;
    }
    return false;
  }

  #beside(component: ComponentName, frame: FrameEntry): Beside | null {
    const { store, studio } = this.#services;
    const other = otherThan(component);
    const cell = cellOf(store.doc, frame.id, other);
    const mesh = studio.meshOf(store.doc.components[other].model?.sha256 ?? '');
    const pose = chosenCandidate(cell)?.pose;
    if (!mesh || !pose || !cell.outline?.closed) return null;
    const outline = Float64Array.from(cell.outline.points.flatMap(({ column, row }) => [column, row]));
    return { middle: inCamera(pose, middleOf(mesh)), outline };
  }

  async #search(place: Place, number: number, worker: Worker, signal: AbortSignal, cancel: () => void, beside: Beside | null = null): Promise<FramePoint | null> {
    const { store, studio } = this.#services;
    const frame = store.doc.frames[number];
    const pixels = frame && (await studio.framePixels(frame.id));
    if (!frame || !pixels) throw new Error(texts.follow.gone(number + 1));
    const job = { title: texts.follow.looking(texts.component[place.component], number + 1), unit: texts.tracing.said.percent, total: 100, cancel, place };
    const found = await asJob(store, job, (report) =>
      worker.call('find', { ...pixels, beside }, {
        signal,
        transfer: [pixels.pixels.buffer],
        onProgress: ({ fraction }) => report(Math.round(100 * fraction), 100),
      }),
    );
    return found && framePoint(found[0] ?? 0, found[1] ?? 0);
  }
}
