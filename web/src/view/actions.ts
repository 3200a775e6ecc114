import * as commands from '../document/commands';
import { currentCell, currentPlace, type Store } from '../document/store';
import { cellOf, chosenCandidate, type ComponentName } from '../document/types';
import { openDemonstration } from '../engine/demonstration';
import { openFiles, type Incoming } from '../engine/opener';
import { saveSession } from '../engine/saver';
import { sentenceOf, type Services } from '../engine/services';
import { canvasPoint } from '../geometry/points';
import { zoomAt, type Size, type Viewport } from '../geometry/viewport';
import type { Action } from '../interaction/bindings';
import { FEWEST_POINTS } from '../interaction/hit';
import { download, pickFiles } from './files';

/** What actions need of the stage. */
export interface StageControls {
  size(): Size;
  viewport(): Viewport;
  /** A gesture of the mouse is under way. */
  busy(): boolean;
  focus(): void;
  cancel(): void;
}

/** What buttons and keys do. */
export class Actions {
  readonly #services: Services;
  readonly #store: Store;
  /** Lent by the stage: what "fit" and "zoom" refer to. */
  stage: StageControls | null = null;

  constructor(services: Services) {
    this.#services = services;
    this.#store = services.store;
  }

  /** Runs what a key or a button asks for. Returns false when there is nothing to do. */
  run(action: Action): boolean {
    const store = this.#store;
    if (this.stage?.busy()) {
      // The hand is in the middle of something: Esc lets go of it, everything else waits.
      if (action.name === 'leave') this.stage.cancel();
      return true;
    }
    switch (action.name) {
      case 'tool':
        store.show({ tool: action.tool });
        return true;
      case 'undo':
        store.undo();
        return true;
      case 'redo':
        store.redo();
        return true;
      case 'save':
        this.saveSession();
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
        store.selectComponent(store.ui.component === 'femur' ? 'tibia' : 'femur');
        return true;
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
      case 'reset-window':
        this.#store.perform(commands.setWindow(null));
        return true;
      default:
        return false;
    }
  }

  // --- Outlines -----------------------------------------------------------------------------------------------

  closeOutline(): boolean {
    const place = currentPlace(this.#store.state);
    const { outline } = currentCell(this.#store.state);
    if (!place || !outline || outline.closed) return false;
    const missing = FEWEST_POINTS - outline.points.length;
    if (missing > 0) {
      this.#store.say('info', `An outline needs ${FEWEST_POINTS} points: ${missing} more, then it can be closed.`);
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

  chooseOtherCandidate(): boolean {
    const place = currentPlace(this.#store.state);
    const { result } = currentCell(this.#store.state);
    if (!place || result?.kind !== 'posed' || result.candidates.length < 2) return false;
    this.#store.perform(commands.chooseCandidate(place, (result.chosen + 1) % result.candidates.length));
    return true;
  }

  /** Esc closes what is open, then leaves the tool for the one that edits. */
  #leave(): boolean {
    const { ui } = this.#store;
    if (ui.popover) this.#store.show({ popover: null });
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
    await this.open((await pickFiles()).map((file) => ({ ...file, component })));
  }

  async open(files: readonly Incoming[]): Promise<void> {
    if (files.length > 0) await this.#telling(() => openFiles(this.#services, files));
  }

  async openDemonstration(): Promise<void> {
    await this.#telling(() => openDemonstration(this.#services));
  }

  saveSession(includeFiles = true): void {
    const { store } = this.#services;
    const doc = store.doc;
    download(saveSession(this.#services, includeFiles), `${fileStem(doc.name)}.fluoropose.json`, 'application/json');
    store.markSaved(doc);
    store.show({ savedAt: Date.now(), popover: null });
    store.say('info', includeFiles ? 'Session saved, with every file it needs.' : 'Session saved; its files are named by digest, keep them.');
  }

  savePoses(component: ComponentName): void {
    const { store, studio } = this.#services;
    const { doc } = store;
    const poses = doc.frames.map((frame) => chosenCandidate(cellOf(doc, frame.id, component))?.pose ?? null);
    const without = doc.frames.filter((_, index) => !poses[index]).length;
    download([studio.writePoses(poses)], `${fileStem(doc.name)}_${component}.jts`, 'text/plain');
    const rest = without === 0 ? '' : ` ${without} without a pose: rows of zeros.`;
    store.say('info', `Poses of the ${component} saved, a row for each of ${poses.length} frames.${rest}`);
  }

  hasPoses(component: ComponentName): boolean {
    const { doc } = this.#store;
    return doc.frames.some((frame) => chosenCandidate(cellOf(doc, frame.id, component)) !== null);
  }

  async #telling(work: () => Promise<void>): Promise<void> {
    try {
      await work();
    } catch (error) {
      this.#store.say('error', sentenceOf(error));
    }
  }
}

function fileStem(name: string): string {
  return name.trim().replace(/[^\p{L}\p{N}._-]+/gu, '_') || 'study';
}

