import { currentCell, currentFrame, type State, type Store } from '../document/store';
import { isDiscarded, isSurpassed } from '../document/laid_by';
import { cellOf, chosenCandidate, type Doc, type FrameEntry, type GreyWindow, type Outline } from '../document/types';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import type { TracingTools } from '../tracing/tracing_tools';
import { NO_PREVIEW, pointsOfPreview, type Preview } from '../tracing/preview';
import type { EdgeWatch } from '../jobs/edge_watch';
import type { Calibrator } from '../jobs/calibrator';
import { cameraOf } from '../results/keys';
import type { Box, Studio } from '../films/studio';
import type { CanvasPoint } from '../geometry/points';
import { canvasFromFrame, fit, frameFromCanvas, type Size, type Viewport } from '../geometry/viewport';
import { handleAt } from '../interaction/adjust';
import type { HandSituation } from '../interaction/hand_situation';
import { hitDraft, hitTest, type Hit } from '../interaction/hit';
import { drawBrush, drawCross, drawHold, drawPreview, drawTransformBox } from './tracing_drawing';
import { drawMeasuring } from './calibrate_drawing';
import { drawOutline, drawRubberBand, drawSilhouette } from './drawing';
import { COMPONENT_COLOURS } from '../controls/colours';
import { handSituationOf } from '../commands/model_in_hand';
import { boxRound, Ink } from './ink';
import { FrameLayer, OverlayLayer } from './layers';
import { drawMisses } from './misses';
import { pointerStore } from '../commands/pointer';
import { Shading } from './shading';
import { drawClicks, drawGhosts, drawHandles, drawLens, drawShaded, lensAt, ReferenceLayers, strokeBorder } from './stage_extras';
import { texts } from '../texts/texts';

const NOTHING: Hit = { kind: 'nothing' };

const FALLBACK_WINDOW: GreyWindow = { centre: 128, width: 256 };

/**
 * Draws the stage: the frame on one canvas, overlays and outlines on another above it, at the screen's own resolution.
 * Everything is redrawn from the state at most once a screen frame.
 */
export class StageView {
  readonly #store: Store;
  readonly #studio: Studio;
  readonly #picture: HTMLCanvasElement;
  readonly #ink: Ink;
  /** Tells what lies under a place; nothing is drawn on it. */
  readonly #probe = document.createElement('canvas').getContext('2d');
  readonly #frameLayer = new FrameLayer();
  readonly #reference = new ReferenceLayers();
  readonly #shading: Shading;
  /** The viewport of the stage, not that of the lens. */
  #mainView: Viewport | null = null;
  readonly #overlays = COMPONENT_NAMES.map((component) => new OverlayLayer(component));
  /** Where the pointer is; what lies under it is found anew whenever something changes. */
  #pointer: CanvasPoint | null = null;
  #byKeys = false;
  #size: Size = { width: 1, height: 1 };
  #drawnFrame = '';
  #scheduled = 0;
  /** Tools that work with pixels: they get a slice of each screen frame, and show what they would do. */
  tracingTools: Pick<TracingTools, 'tick' | 'preview' | 'scale'> | null = null;
  calibrator: Pick<Calibrator, 'beadsShown'> | null = null;
  edges: Pick<EdgeWatch, 'of'> | null = null;

  constructor(store: Store, studio: Studio, picture: HTMLCanvasElement, ink: HTMLCanvasElement) {
    this.#store = store;
    this.#studio = studio;
    this.#shading = new Shading(store, studio);
    this.#picture = picture;
    this.#ink = new Ink(ink);
  }

  get pointer(): CanvasPoint | null {
    return this.#pointer;
  }

  get size(): Size {
    return this.#size;
  }

  resize(size: Size): void {
    this.#size = size;
    const ratio = window.devicePixelRatio || 1;
    this.#picture.width = Math.max(1, Math.round(size.width * ratio));
    this.#picture.height = Math.max(1, Math.round(size.height * ratio));
    this.#drawnFrame = '';
    this.draw();
  }

  /** Of who moves it by keys the system shows none. */
  setPointer(pointer: CanvasPoint | null, by: 'mouse' | 'keys' = 'mouse'): void {
    this.#pointer = pointer;
    this.#byKeys = by === 'keys';
    this.schedule();
  }

  schedule(): void {
    this.#scheduled ||= requestAnimationFrame(() => {
      this.#scheduled = 0;
      this.draw();
    });
  }

  viewport(state: State): Viewport {
    const frame = currentFrame(state);
    return state.ui.viewport ?? fit(frame ?? { width: 1, height: 1 }, this.#size);
  }

  window(state: State): GreyWindow {
    const frame = currentFrame(state);
    return state.history.present.window ?? (frame && this.#studio.frameFacts(frame.id)?.window) ?? FALLBACK_WINDOW;
  }

  /** What a hand on the model works with; null with any other tool. */
  hand(state: State): HandSituation | null {
    return state.ui.tool === 'pose' ? handSituationOf(state, this.#studio) : null;
  }

  draw(): void {
    this.#letTracingToolsWork();
    const { state } = this.#store;
    const frame = currentFrame(state);
    // The frame before stays for the moment that it takes to bring this one, with all that is drawn on it.
    if (frame && this.#studio.hasFrame(frame.id) && !this.#studio.holdsFrame(frame.id)) return;
    const view = this.viewport(state);
    const hit = this.#hit(state, view);
    const hand = this.hand(state);
    const motion = hand && this.#pointer && (handleAt(hand, view, this.#pointer) ?? 'move');
    pointerStore.set(frame && this.#pointer && { at: frameFromCanvas(view, this.#pointer), hit, motion });
    this.#drawFrame(state, frame, view);
    const preview = this.tracingTools?.preview(state.ui.tool) ?? NO_PREVIEW;
    for (const overlay of this.#overlays) if (frame) this.#updateOverlay(overlay, state.history.present, frame);
    const context = this.#ink.begin(this.#inkBox(state, view, preview));
    this.#mainView = view;
    if (frame && !state.ui.overlaysHidden) this.#drawVectors(context, state, frame, view, hit);
    if (frame && !state.ui.overlaysHidden) this.#drawPreview(context, state, view, preview);
    if (frame) drawClicks(context, state, frame, view);
    if (frame && hand && !hand.absent && !state.ui.overlaysHidden) drawHandles(context, hand, view, state.ui.component, this.#pointer);
    if (frame) this.#drawMeasuring(context, state, frame, view);
    if (frame) this.#drawLens(context, state, frame, view);
  }

  /** Which component's model lies under a place, the selected one first. */
  modelAt(at: CanvasPoint): ComponentName | null {
    const { state } = this.#store;
    const { column, row } = frameFromCanvas(this.viewport(state), at);
    const hit = this.#overlays.filter(({ border }) => border && this.#probe?.isPointInPath(border, column, row));
    return (hit.find(({ component }) => component === state.ui.component) ?? hit[0])?.component ?? null;
  }

  /** The part of the stage that is drawn on: around the outlines, models and previews; all of it where a tool or a look draws elsewhere too. */
  #inkBox(state: State, view: Viewport, preview: Preview): Box {
    const { ui, history } = state;
    const { seeing, tool } = ui;
    const calibrating = ui.popover === 'calibrate';
    const anywhere = seeing.magnifier || seeing.ghosts || seeing.comparing || seeing.overlay === 'shaded' || calibrating;
    if (anywhere || tool === 'pose' || tool === 'transform' || tool === 'brush') return { left: 0, top: 0, ...this.#size };
    const points = this.#overlays.flatMap(({ extent }) => extent);
    const frame = currentFrame(state);
    for (const component of COMPONENT_NAMES) points.push(...(cellOf(history.present, frame?.id, component).outline?.points ?? []));
    points.push(...pointsOfPreview(preview));
    const drawn = points.map((point) => canvasFromFrame(view, point));
    for (const { at, place } of ui.jobs) if (at && place?.frameId === frame?.id) drawn.push(canvasFromFrame(view, at));
    // A draft's last side ends at the pointer.
    if ((tool === 'trace' || this.#byKeys) && this.#pointer) drawn.push(this.#pointer);
    return boxRound(drawn, this.#size);
  }

  /** Everything once more, larger, beside the pointer. */
  #drawLens(context: CanvasRenderingContext2D, state: State, frame: FrameEntry, view: Viewport): void {
    const pointer = this.#pointer;
    if (!state.ui.seeing.magnifier || !pointer) return;
    const lens = lensAt(pointer, view, this.#size);
    drawLens(context, lens, () => {
      context.imageSmoothingEnabled = false;
      if (this.#studio.holdsFrame(frame.id)) drawFrameSized(context, this.#frameLayer.canvas, frame, lens.view);
      if (state.ui.overlaysHidden) return;
      // A line to the pointer ends in the middle of the lens.
      this.#pointer = lens.centre;
      this.#drawVectors(context, state, frame, lens.view, NOTHING);
      this.#pointer = pointer;
    });
  }

  #drawMeasuring(context: CanvasRenderingContext2D, state: State, frame: FrameEntry, view: Viewport): void {
    const { popover, measuring } = state.ui;
    if (popover !== 'calibrate' || !measuring || !this.calibrator) return;
    const { grid } = measuring;
    const beads = grid?.frameId === frame.id ? this.calibrator.beadsShown(grid, state.history.present) : null;
    drawMeasuring(context, view, measuring, beads);
  }

  #letTracingToolsWork(): void {
    if (!this.tracingTools) return;
    this.tracingTools.scale = this.viewport(this.#store.state).scale;
    if (this.tracingTools.tick(this.#store.ui.tool)) this.schedule();
  }

  #drawPreview(context: CanvasRenderingContext2D, state: State, view: Viewport, preview: Preview): void {
    const { tool, component, tracing } = state.ui;
    const { outline } = currentCell(state);
    drawPreview(context, view, component, preview);
    if (tool === 'transform' && outline) drawTransformBox(context, view, component, outline, this.#pointer);
    if (tool === 'stretch' && outline?.closed) drawHold(context, view, component, outline, this.#pointer);
    if (tool === 'brush' && this.#pointer) drawBrush(context, component, this.#pointer, tracing.radius * view.scale, tracing.erase);
    else if (this.#byKeys && this.#pointer) drawCross(context, component, this.#pointer);
  }

  #hit(state: State, view: Viewport): Hit {
    const { outline } = currentCell(state);
    if (!this.#pointer || !handlesShown(state)) return NOTHING;
    const drafting = state.ui.tool !== 'edit' && outline?.closed !== true;
    return (drafting ? hitDraft : hitTest)(outline, view, this.#pointer);
  }

  /** Handed on as a picture: a canvas that can be drawn on is copied in every screen frame, changed or not. */
  #drawFrame(state: State, frame: FrameEntry | null, view: Viewport): void {
    const key = frame ? this.#frameKey(state, frame, view) : 'none';
    if (key === this.#drawnFrame) return;
    this.#drawnFrame = key;
    const drawn = new OffscreenCanvas(this.#picture.width, this.#picture.height);
    const context = drawn.getContext('2d');
    if (context && frame && this.#studio.holdsFrame(frame.id)) {
      context.scale(devicePixelRatio, devicePixelRatio);
      this.#frameLayer.update(this.#studio, frame, this.window(state), state.ui.seeing.preprocessing);
      // Pixels are shown as pixels as soon as they are large enough to be told apart.
      context.imageSmoothingEnabled = view.scale * devicePixelRatio < 3;
      context.imageSmoothingQuality = 'high';
      drawFrameSized(context, this.#frameLayer.canvas, frame, view);
    }
    this.#picture.getContext('bitmaprenderer')?.transferFromImageBitmap(drawn.transferToImageBitmap());
  }

  #frameKey(state: State, frame: FrameEntry, view: Viewport): string {
    const window = this.window(state);
    return `${frame.id} ${this.#studio.holdsFrame(frame.id)} ${this.#studio.framesKey} ${state.ui.seeing.preprocessing} ${window.centre} ${window.width} ${view.scale} ${view.left} ${view.top}`;
  }

  #drawVectors(context: CanvasRenderingContext2D, state: State, frame: FrameEntry, view: Viewport, hit: Hit): void {
    const { component: active, overlayOpacity } = state.ui;
    const { present: doc } = state.history;
    // The selected component lies on top.
    const order = [...this.#overlays].sort((a, b) => Number(a.component === active) - Number(b.component === active));
    const shaded = view === this.#mainView ? this.#shading.picture(state, frame, view, this.#size) : null;
    if (shaded && overlayOpacity > 0) drawShaded(context, shaded, this.#size, overlayOpacity);
    for (const overlay of order) {
      if (overlay.border && !shaded) this.#drawModel(context, state, view, overlay, overlayOpacity);
      const edges = this.edges?.of(chosenCandidate(cellOf(doc, frame.id, overlay.component)));
      if (overlay.border && edges) drawMisses(context, view, edges);
      if (overlay.border && isSurpassed(cellOf(doc, frame.id, overlay.component))) {
        strokeBorder(context, view, overlay.border, COMPONENT_COLOURS[overlay.component].css);
      }
    }
    this.#reference.draw(context, state, this.#studio, frame, view);
    drawGhosts(context, state, view);
    for (const { component } of order) {
      const cell = cellOf(doc, frame.id, component);
      const isCorrected = component === active && handlesShown(state);
      if (cell.outline && (isCorrected || !isDiscarded(cell))) this.#drawOutline(context, state, view, component, cell.outline, isSurpassed(cell), hit);
    }
  }

  /** As an outline, filled, or shaded where that can be drawn. */
  #drawModel(context: CanvasRenderingContext2D, state: State, view: Viewport, overlay: OverlayLayer, opacity: number): void {
    if (!overlay.border || opacity === 0) return;
    const { overlay: style } = state.ui.seeing;
    if (style === 'fill') return drawSilhouette(context, view, overlay, opacity);
    strokeBorder(context, view, overlay.border, COMPONENT_COLOURS[overlay.component].light);
  }

  #updateOverlay(overlay: OverlayLayer, doc: Doc, frame: FrameEntry): void {
    const { component } = overlay;
    const { model } = doc.components[component];
    const held = model && this.#studio.meshOf(model.sha256) ? model.sha256 : null;
    const candidate = chosenCandidate(cellOf(doc, frame.id, component));
    const trouble = overlay.update(this.#studio, cameraOf(doc, frame), held, candidate);
    if (trouble) queueMicrotask(() => this.#store.say('error', texts.said.notShown(texts.component[component], trouble)));
  }

  #drawOutline(
    context: CanvasRenderingContext2D,
    state: State,
    view: Viewport,
    component: ComponentName,
    outline: Outline,
    faint: boolean,
    hit: Hit,
  ): void {
    const active = component === state.ui.component;
    const { tool, selectedPoint } = state.ui;
    const points = outline.points.map((point) => canvasFromFrame(view, point));
    const handles = active && handlesShown(state);
    const selected = handles ? selectedPoint : null;
    const { closed, unknownSides } = outline;
    drawOutline(context, component, points, { closed, unknownSides, active, faint, handles, hit: handles ? hit : NOTHING, selected, pointer: this.#pointer });
    const last = points.at(-1);
    if (active && tool === 'trace' && !outline.closed && last && this.#pointer) {
      drawRubberBand(context, component, last, (hit.kind === 'vertex' && points[hit.index]) || this.#pointer);
    }
  }
}

function handlesShown({ ui }: State): boolean {
  return ui.tool === 'edit' || ui.tool === 'trace' || ui.tool === 'wire';
}

export function drawFrameSized(context: CanvasDrawImage, image: CanvasImageSource, frame: Size, view: Viewport): void {
  context.drawImage(image, view.left, view.top, frame.width * view.scale, frame.height * view.scale);
}
