import * as commands from '../document/commands';
import { currentCell, currentPlace, type Store } from '../document/store';
import { unknownFraction } from '../document/sides';
import { cellOf, chosenCandidate } from '../document/types';
import { otherThan, type ComponentName } from '../terms/component';
import type { Incoming } from '../exchange/incoming';
import { meantFiles, type Located } from '../exchange/reading';
import { sentenceOf, type Services } from '../jobs/services';
import { canvasPoint } from '../geometry/points';
import { zoomAt, type Size, type Viewport } from '../geometry/viewport';
import type { TracingCommand } from './tracing_keys';
import type { Action } from './bindings';
import { FEWEST_POINTS, sideMeant } from '../interaction/hit';
import type { TracingTools } from '../tracing/tracing_tools';
import type { Videos } from '../exchange/videos';
import { Aborted } from '../workers/bridge';
import { ended } from '../texts/sentences';
import { texts } from '../texts/texts';
import { TracingActions } from './tracing_actions';
import { download, type Dropped, pickFiles } from '../exchange/browser_files';
import { troubleOf } from '../exchange/trouble';
import { sessionName } from '../terms/file_name';
import { pointerStore } from './pointer';
import { otherTheme } from '../keep/theme';
import { componentToOutline } from '../results/steps';
import type { ToolName } from '../terms/tool';
import { redo, undo } from './undoing';
import { WorkActions } from './work_actions';

/** Tools that begin outlines. A brush changes the one that there is. */
const OUTLINING: readonly ToolName[] = ['trace', 'wire', 'threshold'];

const NOTHING_HIT = { kind: 'nothing' } as const;

/** What actions need of the stage. */
export interface StageControls {
  size(): Size;
  viewport(): Viewport;
  /** A gesture of the mouse is under way. */
  busy(): boolean;
  focus(): void;
  cancel(): void;
  /** The keyboard moves the pointer by frame pixels, and presses there. */
  point(columns: number, rows: number): void;
  press(): void;
}

/** What buttons and keys do. */
export class Actions {
  readonly #services: Services;
  readonly #store: Store;
  /** Set by the stage: what "fit" and "zoom" refer to. */
  stage: StageControls | null = null;

  /** Set when there are any: pictures of videos come back through `open`. */
  videos: Pick<Videos, 'begin'> | null = null;

  /** The work of before comes back first: it would take the place of what is opened meanwhile. */
  restored: Promise<unknown> = Promise.resolve();

  /** Marks, notes and what is next. */
  readonly work: WorkActions;

  /** Whole outlines and the tools' options. */
  readonly tracing: TracingActions;

  constructor(services: Services, tracingTools: TracingTools) {
    this.#services = services;
    this.#store = services.store;
    this.tracing = new TracingActions(services, tracingTools, () => this.stage);
    this.work = new WorkActions(services);
  }

  /** Runs what a key or a button asks for. Returns false when there is nothing to do. */
  run(action: Action): boolean {
    const store = this.#store;
    if (this.stage?.busy()) {
      // The hand is in the middle of something: Esc lets go of it, everything else waits.
      if (action.name === 'leave') this.stage.cancel();
      // The keyboard drags as the mouse does: by pointing and pressing once more.
      if (action.name === 'tracing' && (action.command.what === 'point' || action.command.what === 'press')) this.tracing.run(action.command);
      return true;
    }
    switch (action.name) {
      case 'tool':
        if (OUTLINING.includes(action.tool)) store.selectComponent(componentToOutline(store.state));
        store.show({ tool: action.tool });
        return true;
      case 'tracing':
        return this.#trace(action.command);
      case 'undo':
        undo(store);
        return true;
      case 'redo':
        redo(store);
        return true;
      case 'save':
        void this.saveSession();
        return true;
      case 'open':
        void this.openPicked();
        return true;
      case 'previous-frame':
        store.goTo(store.ui.frameIndex - 1);
        return true;
      case 'next-frame':
        store.goTo(store.ui.frameIndex + 1);
        return true;
      case 'other-component':
        store.selectComponent(otherThan(store.ui.component));
        return true;
      case 'work':
        return this.work.run(action.command);
      case 'keys':
        store.show({ popover: store.ui.popover === 'keys' ? null : 'keys' });
        return true;
      default:
        return this.#onOutlineOrView(action);
    }
  }

  #onOutlineOrView(action: Action): boolean {
    switch (action.name) {
      case 'close-outline':
        return this.closeOutline();
      case 'delete-point':
        return this.deletePoint();
      case 'delete-outline':
        return this.deleteOutline();
      case 'previous-point':
        return this.#selectPoint(-1);
      case 'next-point':
        return this.#selectPoint(1);
      case 'toggle-unknown':
        return this.toggleUnknownSide();
      case 'other-candidate':
        return this.chooseOtherCandidate();
      case 'leave':
        return this.#leave();
      case 'fit':
        this.#store.show({ viewport: null });
        return true;
      case 'zoom-in':
        return this.#zoom(1.25);
      case 'zoom-out':
        return this.#zoom(0.8);
      case 'theme':
        this.#store.show({ theme: otherTheme(this.#store.ui.theme) });
        return true;
      case 'reset-window':
        this.#store.perform(commands.setWindow(null));
        return true;
      default:
        return false;
    }
  }

  /** What a tool has no use for is what the key means otherwise. */
  #trace(command: TracingCommand): boolean {
    if (this.tracing.run(command)) return true;
    if (command.what === 'accept') return this.closeOutline();
    return command.what === 'take-back' && this.deletePoint();
  }

  // --- Outlines -----------------------------------------------------------------------------------------------

  closeOutline(): boolean {
    const place = currentPlace(this.#store.state);
    const { outline } = currentCell(this.#store.state);
    if (!place || !outline || outline.closed) return false;
    const missing = FEWEST_POINTS - outline.points.length;
    if (missing > 0) {
      this.#store.say('info', texts.said.tooFewPoints(FEWEST_POINTS, missing));
      return true;
    }
    this.#store.perform(commands.closeOutline(place));
    return true;
  }

  deletePoint(): boolean {
    const { state } = this.#store;
    const place = currentPlace(state);
    const { outline } = currentCell(state);
    const last = outline && !outline.closed ? outline.points.length - 1 : null;
    const index = state.ui.selectedPoint ?? last;
    if (!place || !outline || index === null || index >= outline.points.length) return false;
    this.#store.perform(commands.deletePoint(place, index));
    this.#store.show({ selectedPoint: null });
    return true;
  }

  deleteOutline(): boolean {
    const place = currentPlace(this.#store.state);
    if (!place || !currentCell(this.#store.state).outline) return false;
    this.#store.perform(commands.deleteOutline(place));
    this.#store.show({ selectedPoint: null, tool: 'trace' });
    return true;
  }

  /** What a click found is not right, or a click is not wanted: the next clicks go around the implant. */
  traceInstead(): void {
    if (!this.deleteOutline()) this.#store.show({ tool: 'trace' });
  }

  /** The outline was of the other component. */
  giveOutline(to: ComponentName): void {
    const place = currentPlace(this.#store.state);
    if (!place) return;
    this.#store.perform(commands.giveOutline(place, to));
    this.#store.selectComponent(to);
  }

  /** By keyboard through the points, round and round. */
  #selectPoint(step: number): boolean {
    const { state } = this.#store;
    const count = currentCell(state).outline?.points.length ?? 0;
    if (count === 0) return false;
    const { selectedPoint } = state.ui;
    const next = selectedPoint === null ? (step > 0 ? 0 : count - 1) : (selectedPoint + step + count) % count;
    this.#store.show({ selectedPoint: next });
    this.#store.say('info', texts.said.selectedPoint(next + 1, count));
    return true;
  }

  /** The side under the pointer, else the one after the selected point, else the one after the point under the pointer. */
  toggleUnknownSide(): boolean {
    const { state } = this.#store;
    const place = currentPlace(state);
    const { outline } = currentCell(state);
    if (!place || !outline?.closed) {
      this.#store.say('info', texts.said.closeFirst);
      return true;
    }
    const side = sideMeant(pointerStore.place?.hit ?? NOTHING_HIT, state.ui.selectedPoint, outline.points.length);
    if (side === null) {
      this.#store.say('info', texts.said.whichSide);
      return true;
    }
    this.#store.perform(commands.toggleUnknownSide(place, side));
    this.#tellUnknown(side);
    return true;
  }

  #tellUnknown(side: number): void {
    const { outline } = currentCell(this.#store.state);
    if (!outline) return;
    const { points, unknownSides } = outline;
    const fraction = Math.round(100 * unknownFraction(outline));
    const { sideKnown, sideUnknown } = texts.said;
    const sentence = unknownSides.includes(side)
      ? sideUnknown(side + 1, points.length, this.#services.studio.unknownReach, fraction)
      : sideKnown(side + 1, points.length, fraction);
    this.#store.say('info', sentence);
  }

  chooseOtherCandidate(): boolean {
    const place = currentPlace(this.#store.state);
    const { result } = currentCell(this.#store.state);
    if (!place || result?.kind !== 'posed' || result.candidates.length < 2) return false;
    return this.chooseCandidate((result.chosen + 1) % result.candidates.length);
  }

  chooseCandidate(index: number): boolean {
    const place = currentPlace(this.#store.state);
    if (!place) return false;
    this.#store.perform(commands.chooseCandidate(place, index));
    this.#store.say('info', texts.said.taken(index + 1));
    return true;
  }

  /** Esc closes what is open, then leaves the tool for the one that edits. */
  #leave(): boolean {
    const { ui } = this.#store;
    if (ui.popover) this.#store.show({ popover: null });
    else if (ui.checking) this.#store.show({ checking: false });
    else if (ui.selectedPoint !== null) this.#store.show({ selectedPoint: null });
    else this.#store.show({ tool: 'edit' });
    return true;
  }

  #zoom(factor: number): boolean {
    if (!this.stage) return false;
    const { width, height } = this.stage.size();
    const centre = canvasPoint(width / 2, height / 2);
    this.#store.show({ viewport: zoomAt(this.stage.viewport(), centre, factor) });
    return true;
  }

  // --- Files --------------------------------------------------------------------------------------------------

  async openPicked(component?: ComponentName): Promise<void> {
    await this.openLocated(await pickFiles(), component);
  }

  async openFolder(): Promise<void> {
    await this.openLocated(await pickFiles('folder'));
  }

  /** Opens what was dropped; what the browser does not give of it is said last. */
  async openDropped({ files, troubles }: Dropped): Promise<void> {
    await this.openLocated(await files);
    if (troubles.length > 0) this.#store.say('error', troubles.map((trouble) => ended(troubleOf(...trouble))).join(' '));
  }

  /** Opens files, whatever they are. */
  async openLocated(files: readonly Located[], component?: ComponentName): Promise<void> {
    const meant = meantFiles(files);
    if (files.length > 0 && meant.length === 0) this.#store.say('info', texts.files.nothing);
    await this.open(meant.map((file) => ({ ...file, component })));
  }

  /** True where the work that they are for is on view in the end. */
  async open(files: readonly Incoming[]): Promise<boolean> {
    let isHere = false;
    if (files.length === 0) return isHere;
    await this.#telling(async () => {
      const { openFiles } = await import('../exchange/opener');
      await this.restored;
      isHere = await openFiles(this.#services, files, (file) => this.videos?.begin(file));
    });
    return isHere;
  }

  async openDemonstration(): Promise<void> {
    await this.#telling(async () => {
      const { openDemonstration } = await import('../exchange/demonstration');
      await this.restored;
      await openDemonstration(this.#services);
    });
  }

  async saveSession(includeFiles = true): Promise<void> {
    await this.#telling(() => this.#writeSession(includeFiles));
  }

  async #writeSession(includeFiles: boolean): Promise<void> {
    const { store } = this.#services;
    const { saveSession } = await import('../exchange/saver');
    const doc = store.doc;
    const { parts, without } = await saveSession(this.#services, includeFiles);
    download(parts, sessionName(doc.name, includeFiles), 'application/json');
    store.markSaved(doc);
    store.show({ savedAt: Date.now() });
    if (without.length > 0) store.say('error', texts.said.sessionSavedWithout(texts.listed(without)));
    else store.say('info', includeFiles ? texts.said.sessionSaved : texts.said.sessionSavedWithoutFiles);
  }

  hasPoses(component: ComponentName): boolean {
    const { doc } = this.#store;
    return doc.frames.some((frame) => chosenCandidate(cellOf(doc, frame.id, component)) !== null);
  }

  async #telling(work: () => Promise<void>): Promise<void> {
    try {
      await work();
    } catch (error) {
      this.#store.say(error instanceof Aborted ? 'info' : 'error', error instanceof Aborted ? texts.files.called : sentenceOf(error));
    }
  }
}
