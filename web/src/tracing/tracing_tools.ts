import { currentCell, currentFrame, currentPlace } from '../document/store';
import { cellOf } from '../document/types';
import type { FramePoint } from '../geometry/points';
import type { TracingIntent } from '../interaction/tracing_intent';
import type { ToolName } from '../terms/tool';
import type { FrameImage } from '../pkg/page/fluoropose_page.js';
import { texts } from '../texts/texts';
import { sentenceOf, type Services } from '../jobs/services';
import { componentMeant } from '../results/steps';
import { Host } from './host';
import type { OneClick } from './one_click';
import { brushRefusal, paint } from './painting';
import { coolingOf, regionOf, wireOf } from './pixels';
import { NO_PREVIEW, type Preview } from './preview';
import { Threshold } from './threshold';
import { Wire } from './wire';

/** Work of this length leaves time for drawing in a screen frame, ms. */
const BUDGET = 4;
/** A path has to stay the same for so long while the hand moves, ms. */
const COOLS_AFTER = 700;
type Held<T> = { readonly image: FrameImage; readonly bright: boolean; readonly tool: T } | null;

/**
 * The tools that work with pixels: answers what their machines want with previews and commands. Keeps one live-wire and
 * one threshold, of the frame that is traced; everything is done in slices within screen frames.
 */
export class TracingTools {
  readonly #services: Services;
  readonly #oneClick: OneClick;
  #wire: Held<Wire> = null;
  #threshold: Held<Threshold> = null;
  #box: Preview = NO_PREVIEW;
  #shape: Preview = NO_PREVIEW;
  #stroke: Extract<TracingIntent, { tool: 'brush' }> | null = null;
  #trouble = '';
  /** How many CSS pixels a frame pixel is; the stage tells. */
  scale = 1;

  constructor(services: Services, oneClick: OneClick) {
    this.#services = services;
    this.#oneClick = oneClick;
    services.store.subscribe(() => this.#watch());
  }

  /** What the tool in hand would do, or the sheet that is open. */
  preview(tool: ToolName): Preview {
    return this.#telling(() => this.#previewOf(tool)) ?? NO_PREVIEW;
  }

  #previewOf(tool: ToolName): Preview {
    if (this.#shape.kind !== 'nothing') return this.#shape;
    switch (tool) {
      case 'wire':
        return this.#wireOfNow()?.preview ?? NO_PREVIEW;
      case 'threshold':
        return this.#thresholdOfNow()?.preview ?? NO_PREVIEW;
      case 'one-click':
        return this.#box;
      default:
        return NO_PREVIEW;
    }
  }

  want(intent: TracingIntent): void {
    this.#telling(() => this.#answer(intent));
  }

  #answer(intent: TracingIntent): void {
    switch (intent.tool) {
      case 'wire':
        return this.#toWire(intent);
      case 'threshold':
        return this.#toThreshold(intent);
      case 'brush':
        return this.#toBrush(intent);
      case 'one-click':
        return this.#toOneClick(intent);
      case 'none':
        return this.leave();
    }
  }

  /** A slice of work before a screen frame is drawn; true when the next screen frame has more to do. */
  tick(tool: ToolName): boolean {
    return this.#telling(() => this.#work(tool)) ?? false;
  }

  #work(tool: ToolName): boolean {
    if (this.#stroke) this.#paint();
    if (tool === 'threshold') this.#thresholdOfNow()?.tick();
    return tool === 'wire' && !currentCell(this.#services.store.state).outline?.closed && (this.#wireOfNow()?.tick(BUDGET) ?? false);
  }

  /** Whatever goes wrong is said, once: the frame goes on being drawn. */
  #telling<T>(work: () => T): T | null {
    try {
      return work();
    } catch (error) {
      const sentence = sentenceOf(error);
      if (sentence !== this.#trouble) this.#services.store.say('error', sentence);
      this.#trouble = sentence;
      return null;
    }
  }

  /** The pointer has left, or the tool: nothing is shown that a click would not do. */
  leave(): void {
    this.#wire?.tool.leave();
    this.#threshold?.tool.leave();
    this.#box = NO_PREVIEW;
    this.#stroke = null;
  }

  closeWire(): boolean {
    return this.#wireOfNow()?.close() ?? false;
  }

  takeBack(): boolean {
    return this.#wireOfNow()?.takeBack() ?? false;
  }

  /** Moves the level of the region that was taken, or the level of the next one. */
  setLevel(level: number): void {
    if (!this.#thresholdOfNow()?.setLevel(level)) this.#services.store.setTracing({ level });
    this.#tellLevel();
  }

  /** By steps of a hundredth of the frame's range. False where no region was taken. */
  stepLevel(steps: number): boolean {
    const { thresholdLevel } = this.#services.store.ui;
    if (!thresholdLevel) return false;
    this.setLevel(thresholdLevel.level + (steps * (thresholdLevel.greatest - thresholdLevel.least)) / 200);
    return true;
  }

  /** Takes the region again, with other options. */
  takeAgain(): void {
    this.#thresholdOfNow()?.again();
    this.#tellLevel();
  }

  /** What the outline would become; no points where nothing is to be shown. */
  showShape(points: readonly FramePoint[]): void {
    this.#shape = points.length > 0 ? { kind: 'ring', points } : NO_PREVIEW;
    this.#services.store.show({});
  }

  /** Ends of the level's slider, grey values. */
  get levelEnds(): { readonly least: number; readonly greatest: number } | null {
    return this.#threshold?.tool.ends ?? null;
  }

  get adjusting(): boolean {
    return this.#threshold?.tool.taken != null;
  }

  // --- Tools ------------------------------------------------------------------------------------------------------

  #toWire(intent: Extract<TracingIntent, { tool: 'wire' }>): void {
    const wire = this.#wireOfNow();
    if (!wire) return this.#sayNoFrame();
    if (intent.to === 'aim') wire.aim(intent.at, intent.straight);
    else if (intent.to === 'fix') wire.fix(intent.at, intent.straight);
    else wire.close(intent.straight);
  }

  #toThreshold(intent: Extract<TracingIntent, { tool: 'threshold' }>): void {
    const threshold = this.#thresholdOfNow();
    if (!threshold) return this.#sayNoFrame();
    if (intent.to === 'aim') threshold.aim(intent.at);
    else if (intent.to === 'take') threshold.take(intent.at);
    else if (intent.to === 'drag') threshold.drag(intent.down);
    else threshold.letGo();
    if (intent.to !== 'aim') this.#tellLevel();
  }

  #toBrush(intent: Extract<TracingIntent, { tool: 'brush' }>): void {
    this.#stroke = intent;
    if (intent.to === 'finish') this.#paint();
  }

  #toOneClick(intent: Extract<TracingIntent, { tool: 'one-click' }>): void {
    const { store } = this.#services;
    const frame = currentFrame(store.state);
    this.#box = intent.to === 'frame' ? { kind: 'box', from: intent.from, to: intent.at } : NO_PREVIEW;
    if (intent.to === 'frame' || !frame) return;
    const prompt = intent.to === 'box' ? ([intent.from, intent.at] as const) : ([intent.at] as const);
    store.selectComponent(componentMeant(store.state, intent.at));
    void this.#oneClick.ask(prompt, { frameId: frame.id, component: store.ui.component }, store.ui.tracing.bright);
  }

  /** The stroke so far on the outline from before it. */
  #paint(): void {
    const { store } = this.#services;
    const stroke = this.#stroke;
    const place = currentPlace(store.state);
    this.#stroke = null;
    if (!stroke || !place) return;
    const before = cellOf(store.state.history.gestureStart ?? store.doc, place.frameId, place.component).outline;
    const refusal = brushRefusal(before, stroke.erase);
    if (refusal) return stroke.to === 'finish' ? store.say('info', refusal) : undefined;
    const command = paint(place, before, stroke.stroke, store.ui.tracing.radius, stroke.erase);
    if (stroke.to === 'paint') return store.preview(command);
    store.commit(command);
    if (!currentCell(store.state).outline) store.say('info', texts.tracing.said.allErased);
  }

  // --- What they work on --------------------------------------------------------------------------------------------

  #wireOfNow(): Wire | null {
    return this.#held(this.#wire, (held) => (this.#wire = held), (image, bright) =>
      new Wire(wireOf(image, !bright), coolingOf(COOLS_AFTER), this.#hostOf(image, bright)),
    );
  }

  #thresholdOfNow(): Threshold | null {
    return this.#held(this.#threshold, (held) => (this.#threshold = held), (image, bright) =>
      new Threshold(regionOf(image, !bright), this.#hostOf(image, bright)),
    );
  }

  /** The tool of the frame on view; another frame's is given up, it holds much memory. */
  #held<T extends { free(): void }>(held: Held<T>, keep: (held: Held<T>) => void, make: (image: FrameImage, bright: boolean) => T): T | null {
    const { store, studio } = this.#services;
    const frame = currentFrame(store.state);
    const image = frame && studio.imageOf(frame.id);
    const bright = store.ui.tracing.bright ?? false;
    if (held && held.image === image && held.bright === bright) return held.tool;
    held?.tool.free();
    const made = image && { image, bright, tool: make(image, bright) };
    keep(made);
    return made?.tool ?? null;
  }

  #hostOf(image: FrameImage, bright: boolean): Host {
    return new Host(this.#services.store, image, bright, () => this.scale);
  }

  #sayNoFrame(): void {
    const { store } = this.#services;
    const frame = currentFrame(store.state);
    if (frame) store.say('info', texts.tracing.said.noPixels(frame.name));
  }

  #tellLevel(): void {
    const { store } = this.#services;
    const threshold = this.#threshold?.tool;
    const taken = threshold?.taken;
    const thresholdLevel = threshold && taken ? { level: taken.level, ...threshold.ends } : null;
    if (thresholdLevel || store.ui.thresholdLevel) store.show({ thresholdLevel });
  }

  /** Adjusting ends as soon as the outline is another one. */
  #watch(): void {
    if (this.#services.store.ui.thresholdLevel && !this.adjusting) this.#services.store.show({ thresholdLevel: null });
  }
}
