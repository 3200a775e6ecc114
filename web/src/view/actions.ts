import * as commands from '../document/commands';
import { currentCell, currentPlace, type Store } from '../document/store';
import { unknownShare } from '../document/sides';
import { poseTable } from '../document/table';
import { cellOf, chosenCandidate, type ComponentName } from '../document/types';
import { openDemonstration } from '../engine/demonstration';
import { openFiles, type Incoming } from '../engine/opener';
import { saveSession } from '../engine/saver';
import { sentenceOf, type Services } from '../engine/services';
import { canvasPoint } from '../geometry/points';
import { zoomAt, type Size, type Viewport } from '../geometry/viewport';
import type { Action } from '../interaction/bindings';
import { FEWEST_POINTS, sideMeant } from '../interaction/hit';
import { download, pickFiles } from './files';
import { pointerStore } from './pointer';

const NOTHING_HIT = { kind: 'nothing' } as const;

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

  /** By keyboard through the points, round and round. */
  #selectPoint(step: number): boolean {
    const { state } = this.#store;
    const count = currentCell(state).outline?.points.length ?? 0;
    if (count === 0) return false;
    const { selectedPoint } = state.ui;
    const next = selectedPoint === null ? (step > 0 ? 0 : count - 1) : (selectedPoint + step + count) % count;
    this.#store.show({ selectedPoint: next });
    this.#store.say('info', `Point ${next + 1} of ${count}: Delete removes it; U marks the side after it unknown.`);
    return true;
  }

  /** The side under the pointer, else the one after the selected point, else the one after the point under the pointer. */
  toggleUnknownSide(): boolean {
    const { state } = this.#store;
    const place = currentPlace(state);
    const { outline } = currentCell(state);
    if (!place || !outline?.closed) {
      this.#store.say('info', 'Sides can be marked unknown once the outline is closed.');
      return true;
    }
    const side = sideMeant(pointerStore.place?.hit ?? NOTHING_HIT, state.ui.selectedPoint, outline.points.length);
    if (side === null) {
      this.#store.say('info', 'Point at a side of the outline, or select the point before it with , and . keys, then press U.');
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
    const marked = unknownSides.includes(side) ? `unknown: what lies within ${this.#services.studio.unknownReach} px of it is ignored` : 'known';
    const share = Math.round(100 * unknownShare(outline));
    this.#store.say('info', `Side ${side + 1} of ${points.length} is ${marked}. ${share} % of the outline is unknown.`);
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

  async saveSession(includeFiles = true): Promise<void> {
    const { store } = this.#services;
    const doc = store.doc;
    download(await saveSession(this.#services, includeFiles), `${fileStem(doc.name)}.fluoropose.json`, 'application/json');
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

  /** Poses with their standard deviations and why they were chosen, which a .jts file has no room for. */
  saveTable(component: ComponentName): void {
    const { doc } = this.#store;
    download([poseTable(doc, component)], `${fileStem(doc.name)}_${component}.csv`, 'text/csv');
    this.#store.say('info', `Poses of the ${component} saved with their standard deviations, a row for each of ${doc.frames.length} frames.`);
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

