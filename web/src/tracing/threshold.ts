import type { Command, Place } from '../document/command';
import { setOutline } from '../document/outlines';
import type { Outline } from '../document/types';
import type { FramePoint } from '../geometry/points';
import { texts } from '../texts/texts';
import type { Region } from './pixels';
import { NO_PREVIEW, type Preview } from './preview';

export interface ThresholdHost {
  readonly place: Place | null;
  readonly outline: Outline | null;
  /** Null: what suits the place that is pointed at. */
  readonly level: number | null;
  readonly bridge: number;
  perform(command: Command): void;
  say(sentence: string): void;
}

/** The region that was taken and is still being adjusted. */
interface Taken {
  readonly place: Place;
  readonly at: FramePoint;
  readonly level: number;
  /** The level when the hand took hold. */
  readonly grip: number;
  readonly outline: Outline;
  /** Adjusting is the same unit of undo as taking. */
  readonly mergeKey: string;
}

/** A whole drag down the frame goes over half of the frame's grey values. */
const TRAVEL = 800;

let taken = 0;

/** Points at a region, takes it as the outline, and adjusts its level for as long as nothing else changes it. */
export class Threshold {
  readonly #region: Region;
  readonly #host: ThresholdHost;
  #aim: FramePoint | null = null;
  #taken: Taken | null = null;
  #preview: Preview = NO_PREVIEW;

  constructor(region: Region, host: ThresholdHost) {
    this.#region = region;
    this.#host = host;
  }

  free(): void {
    this.#region.free();
  }

  get preview(): Preview {
    return this.taken ? NO_PREVIEW : this.#preview;
  }

  /** Null as soon as the outline is another one, whoever changed it. */
  get taken(): Taken | null {
    if (this.#taken && this.#taken.outline !== this.#host.outline) this.#taken = null;
    return this.#taken;
  }

  get ends(): { readonly least: number; readonly greatest: number } {
    return { least: this.#region.least, greatest: this.#region.greatest };
  }

  aim(at: FramePoint): void {
    this.#aim = at;
  }

  /** The preview of where the hand is: at most once a screen frame. */
  tick(): void {
    if (!this.#aim || this.taken) return;
    this.#preview = this.#previewOf(this.#aim);
    this.#aim = null;
  }

  leave(): void {
    this.#aim = null;
    this.#preview = NO_PREVIEW;
  }

  take(at: FramePoint): void {
    const { place } = this.#host;
    const level = this.#levelAt(at);
    if (!place) return;
    if (level === null) return this.#host.say(texts.tracing.said.flat);
    const mergeKey = `threshold ${++taken}`;
    this.#set({ place, at, level, grip: level, mergeKey });
  }

  /** The hand went so many pixels of the screen down since it took hold. */
  drag(down: number): void {
    const taken = this.taken;
    if (taken) this.setLevel(taken.grip + (down / TRAVEL) * (this.#region.greatest - this.#region.least));
  }

  /** Takes the same place at another level. False where nothing is being adjusted. */
  setLevel(level: number): boolean {
    const taken = this.taken;
    if (!taken) return false;
    const { least, greatest } = this.#region;
    this.#set({ ...taken, level: Math.min(greatest, Math.max(least, level)) });
    return true;
  }

  /** The same place and level with other options. */
  again(): void {
    if (this.taken) this.setLevel(this.taken.level);
  }

  /** The next drag starts from the level of now. */
  letGo(): void {
    if (this.taken) this.#taken = { ...this.taken, grip: this.taken.level };
  }

  #set(wanted: Omit<Taken, 'outline'>): void {
    const points = this.#region.outline(wanted.at, wanted.level, this.#host.bridge);
    if (points.length === 0) {
      if (this.#taken) this.#taken = { ...wanted, outline: this.#taken.outline };
      return this.#host.say(texts.tracing.said.empty(Math.round(wanted.level)));
    }
    const outline: Outline = { points, closed: true, unknownSides: [], laidBy: 'tool' };
    this.#taken = { ...wanted, outline };
    this.#preview = NO_PREVIEW;
    this.#host.perform({ ...setOutline(wanted.place, texts.steps.takeRegion, outline), mergeKey: wanted.mergeKey });
  }

  #levelAt(at: FramePoint): number | null {
    return this.#host.level ?? this.#region.suggest(at);
  }

  #previewOf(at: FramePoint): Preview {
    const level = this.#levelAt(at);
    const points = level === null ? [] : this.#region.outline(at, level, this.#host.bridge);
    return points.length > 0 ? { kind: 'ring', points } : NO_PREVIEW;
  }
}
