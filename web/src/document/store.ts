import type { FramePoint } from '../geometry/points';
import type { Viewport } from '../geometry/viewport';
import { type TracingOptions, USUAL_OPTIONS } from '../terms/tracing';
import type { ToolName } from '../terms/tool';
import type { Command, Place } from './command';
import { gaveWay } from './followed';
import * as history from './history';
import type { Measuring } from './measuring';
import type { Proposal } from './proposal';
import { DEFAULT_EXPORTING, type Exporting } from '../terms/exporting';
import { DEFAULT_JOINT, type JointView } from '../terms/joint';
import { DEFAULT_HAND, DEFAULT_SEEING, type HandSettings, type Seeing } from '../terms/seeing';
import { type Cell, cellKey, cellOf, type Doc, EMPTY_DOC, type FrameEntry, type ModelReference } from './types';
import type { ComponentName } from '../terms/component';
import { texts } from '../texts/texts';

/** Everything the page shows: the document with its history, and what is not worth undoing. */
export interface State {
  readonly history: history.History;
  readonly ui: Ui;
}

export interface Ui {
  readonly frameIndex: number;
  readonly component: ComponentName;
  /** Doubtful poses are gone through, one by one. */
  readonly checking: boolean;
  /** The film is being followed. */
  readonly following: boolean;
  /** Why its frames tell nothing of the film, where their grey values are cut off: a sentence without its full stop. */
  readonly clipped: string | null;
  readonly tool: ToolName;
  /** Null: the whole frame, fitted to the canvas. */
  readonly viewport: Viewport | null;
  readonly selectedPoint: number | null;
  readonly overlayOpacity: number;
  /** How things are shown; `keep/taste.ts` remembers it. */
  readonly seeing: Seeing;
  readonly hand: HandSettings;
  readonly joint: JointView;
  readonly exporting: Exporting;
  readonly tracing: TracingOptions;
  /** The threshold that was taken and can still be moved, grey values. */
  readonly thresholdLevel: ThresholdLevel | null;
  /** Space is held: outlines and overlays step aside. */
  readonly overlaysHidden: boolean;
  readonly popover: Popover | null;
  readonly notice: Notice | null;
  readonly log: readonly Notice[];
  /** Why cells were left as they are, by `cellKey`; one holds as long as its cell is the same. */
  readonly refusals: Readonly<Record<string, Refusal>>;
  readonly jobs: readonly Job[];
  /** When a session file was last written. */
  readonly savedAt: number | null;
  readonly keeping: Keeping;
  /** What is about to be imported; null while nothing is. */
  readonly proposal: Proposal | null;
  /** Files of poses between which a person has to choose; null while there are none. */
  readonly poseSets: PoseSets | null;
  /** What the calibration helper has before it; null before it is first opened. */
  readonly measuring: Measuring | null;
  /** Brings a newer version of the page into use; null while there is none. */
  readonly update: (() => void) | null;
  readonly theme: Theme;
  /** Models whose remarks somebody has read and put away, by SHA-256. */
  readonly dismissed: readonly string[];
  /** Libraries that are open in the pose worker, by component: their key. */
  readonly libraries: Readonly<Record<ComponentName, LibraryState>>;
}

/** Dark like a reading room, or light for projectors. Print is light by itself. */
export type Theme = 'dark' | 'light';

export type Popover = 'calibration' | 'femur' | 'tibia' | 'keys' | 'log' | 'export' | 'convergence' | 'view' | 'work' | 'import' | 'shape' | 'calibrate' | 'video' | 'film' | 'sets';

export interface ThresholdLevel {
  readonly level: number;
  readonly least: number;
  readonly greatest: number;
}

export interface Notice {
  readonly kind: 'info' | 'error';
  readonly text: string;
  readonly at: number;
  /** A button beside the text. */
  readonly offer?: Offer;
  /** It says how good a pose is, or what following a film came to: what its joint tells of it afterwards takes its place, or stands behind it. */
  readonly of?: 'pose' | 'film';
}

/** Several files of poses of one component: one of them is used. */
export interface PoseSets {
  readonly names: Readonly<Record<ComponentName, readonly string[]>>;
  /** Opens the one with this number of each component; null: none. */
  readonly take: (chosen: Readonly<Record<ComponentName, number | null>>) => void;
}

export interface Refusal {
  readonly text: string;
  readonly of: Cell;
  readonly model: ModelReference | null;
}

export interface Offer {
  readonly label: string;
  readonly take: () => void;
}

/** How far the work is in the browser's own storage. */
export type Keeping =
  | { readonly state: 'nothing' }
  /** `since`: when the first change came that is not kept yet. */
  | { readonly state: 'pending'; readonly since: number }
  | { readonly state: 'kept'; readonly at: number }
  | { readonly state: 'refused'; readonly sentence: string };

/** Long work, with a count and a time, that can be called off. */
export interface Job {
  readonly id: number;
  readonly title: string;
  readonly done: number;
  readonly total: number;
  readonly unit: string;
  readonly startedAt: number;
  readonly cancel: () => void;
  /** The cell that it is for; missing where it is for more than one. */
  readonly place?: Place;
  /** The point of the frame that somebody clicked. */
  readonly at?: FramePoint;
}

export type LibraryState =
  | { readonly state: 'none' }
  | { readonly state: 'building'; readonly key: string }
  | { readonly state: 'stopped'; readonly key: string; readonly reason: string }
  | { readonly state: 'ready'; readonly key: string; readonly views: number; readonly bytes: number; readonly seconds: number | null };

const EMPTY_UI: Ui = {
  frameIndex: 0,
  component: 'femur',
  checking: false,
  following: false,
  clipped: null,
  tool: 'trace',
  viewport: null,
  selectedPoint: null,
  overlayOpacity: 0.35,
  seeing: DEFAULT_SEEING,
  hand: DEFAULT_HAND,
  joint: DEFAULT_JOINT,
  exporting: DEFAULT_EXPORTING,
  tracing: USUAL_OPTIONS,
  thresholdLevel: null,
  overlaysHidden: false,
  popover: null,
  notice: null,
  log: [],
  refusals: {},
  jobs: [],
  savedAt: null,
  keeping: { state: 'nothing' },
  proposal: null,
  poseSets: null,
  measuring: null,
  update: null,
  theme: 'dark',
  dismissed: [],
  libraries: { femur: { state: 'none' }, tibia: { state: 'none' } },
};

const LOG_LENGTH = 200;

/** The one store. Listeners are called after every change, synchronously. */
export class Store {
  #state: State = { history: history.startHistory(EMPTY_DOC), ui: EMPTY_UI };
  readonly #listeners = new Set<() => void>();

  get state(): State {
    return this.#state;
  }

  get doc(): Doc {
    return this.#state.history.present;
  }

  get ui(): Ui {
    return this.#state.ui;
  }

  subscribe(listener: () => void): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  // --- Document -----------------------------------------------------------------------------------------------

  perform(command: Command): void {
    this.#work(history.perform(this.#state.history, command));
  }

  preview(command: Command): void {
    this.#toHistory(history.preview(this.#state.history, command));
  }

  /** Ends a gesture with its last command. */
  commit(command: Command): void {
    this.#work(history.commitPreview(history.preview(this.#state.history, command), command));
  }

  cancelPreview(): void {
    this.#toHistory(history.cancelPreview(this.#state.history));
  }

  amend(change: (doc: Doc) => Doc): void {
    this.#toHistory(history.amend(this.#state.history, change));
  }

  undo(): void {
    const step = history.nextUndo(this.#state.history);
    this.#toHistory(history.undo(this.#state.history));
    this.#show(step?.place ?? null);
  }

  redo(): void {
    const step = history.nextRedo(this.#state.history);
    this.#toHistory(history.redo(this.#state.history));
    this.#show(step?.place ?? null);
  }

  /** What is there now is where undo ends, and nothing that needs saving. */
  settle(): void {
    this.#toHistory(history.startHistory(this.doc));
  }

  markSaved(doc: Doc): void {
    this.#toHistory(history.markSaved(this.#state.history, doc));
  }

  // --- What is not undone ---------------------------------------------------------------------------------------

  show(change: Partial<Ui>): void {
    this.#set({ ...this.#state, ui: { ...this.ui, ...change } });
  }

  goTo(frameIndex: number): void {
    const last = Math.max(0, this.doc.frames.length - 1);
    const index = Math.min(last, Math.max(0, frameIndex));
    if (index !== this.ui.frameIndex || this.ui.selectedPoint !== null) this.show({ frameIndex: index, selectedPoint: null });
  }

  selectComponent(component: ComponentName): void {
    if (component !== this.ui.component) this.show({ component, selectedPoint: null });
  }

  see(change: Partial<Seeing>): void {
    this.show({ seeing: { ...this.ui.seeing, ...change } });
  }

  setJoint(change: Partial<JointView>): void {
    this.show({ joint: { ...this.ui.joint, ...change } });
  }

  setTracing(change: Partial<TracingOptions>): void {
    this.show({ tracing: { ...this.ui.tracing, ...change } });
  }

  setHand(change: Partial<HandSettings>): void {
    this.show({ hand: { ...this.ui.hand, ...change } });
  }

  say(kind: Notice['kind'], text: string, offer?: Offer, of?: Notice['of']): void {
    const notice: Notice = { kind, text, at: Date.now(), ...(offer && { offer }), ...(of && { of }) };
    this.show({ notice, log: [...this.ui.log.slice(1 - LOG_LENGTH), notice] });
  }

  /** The same, and it stays with the cell that it is about until that or its model changes. */
  sayAt({ frameId, component }: Place, kind: Notice['kind'], text: string): void {
    this.say(kind, text);
    const refusal = { text, of: cellOf(this.doc, frameId, component), model: this.doc.components[component].model };
    this.show({ refusals: { ...this.ui.refusals, [cellKey(frameId, component)]: refusal } });
  }

  quiet(): void {
    if (this.ui.notice) this.show({ notice: null });
  }

  setJob(job: Job): void {
    const others = this.ui.jobs.filter((other) => other.id !== job.id);
    this.show({ jobs: [...others, job].sort((a, b) => a.id - b.id) });
  }

  endJob(id: number): void {
    this.show({ jobs: this.ui.jobs.filter((job) => job.id !== id) });
  }

  setLibrary(component: ComponentName, library: LibraryState): void {
    this.show({ libraries: { ...this.ui.libraries, [component]: library } });
  }

  /** Takes in what a person did. */
  #work(next: history.History): void {
    const before = this.#state.history.gestureStart ?? this.doc;
    this.#toHistory(next);
    const place = history.nextUndo(next)?.place;
    if (place && gaveWay(before, next.present, place)) this.say('info', texts.follow.gaveWay);
  }

  #show(place: Place | null): void {
    const frameIndex = place ? this.doc.frames.findIndex((frame) => frame.id === place.frameId) : -1;
    if (place && frameIndex >= 0) this.show({ frameIndex, component: place.component, selectedPoint: null });
  }

  #toHistory(next: history.History): void {
    const { frameIndex } = this.ui;
    const last = Math.max(0, next.present.frames.length - 1);
    this.#set({ history: next, ui: frameIndex > last ? { ...this.ui, frameIndex: last } : this.ui });
  }

  #set(state: State): void {
    if (state.history === this.#state.history && state.ui === this.#state.ui) return;
    this.#state = state;
    for (const listener of this.#listeners) listener();
  }
}

// --- What views ask of a state ------------------------------------------------------------------------------------

export function currentFrame(state: State): FrameEntry | null {
  return state.history.present.frames[state.ui.frameIndex] ?? null;
}

export function currentPlace(state: State): Place | null {
  const frame = currentFrame(state);
  return frame && { frameId: frame.id, component: state.ui.component };
}

/** Why the cell on view was left as it is; null where nothing was refused, or the cell or its model has changed since. */
export function currentRefusal(state: State): string | null {
  const place = currentPlace(state);
  const refusal = place && state.ui.refusals[cellKey(place.frameId, place.component)];
  const isOfNow = refusal && refusal.of === currentCell(state) && refusal.model === state.history.present.components[state.ui.component].model;
  return isOfNow ? refusal.text : null;
}

export function currentCell(state: State): Cell {
  return cellOf(state.history.present, currentFrame(state)?.id, state.ui.component);
}
