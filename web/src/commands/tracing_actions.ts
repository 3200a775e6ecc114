import { movePoint } from '../document/commands';
import { copyOutline, markAllKnown, nudgeOutline, setOutline, tracedNeighbour } from '../document/outlines';
import { currentCell, currentFrame, currentPlace } from '../document/store';
import { cellOf, type Outline } from '../document/types';
import type { TracingTools } from '../tracing/tracing_tools';
import { snappedOutline } from '../tracing/snapping';
import type { Services } from '../jobs/services';
import { withoutLoops } from '../geometry/loops';
import { framePoint } from '../geometry/points';
import { boundsOf, middleOf, moved, scaled, rotated, type Similarity } from '../geometry/similarity';
import { RADIUS } from '../terms/tracing';
import type { TracingCommand } from './tracing_keys';
import { texts } from '../texts/texts';

interface Pointing {
  point(columns: number, rows: number): void;
  press(): void;
}

/** What keys and buttons do with whole outlines and with the tools' options. True where there was something to do. */
export class TracingActions {
  readonly #services: Services;
  readonly #tools: TracingTools;
  readonly #stage: () => Pointing | null;

  constructor(services: Services, tools: TracingTools, stage: () => Pointing | null) {
    this.#services = services;
    this.#tools = tools;
    this.#stage = stage;
  }

  run(command: TracingCommand): boolean {
    switch (command.what) {
      case 'move':
        return this.#move(command.columns, command.rows);
      case 'turn':
        return this.#transform((middle) => rotated(middle, (command.degrees * Math.PI) / 180));
      case 'scale':
        return this.#transform((middle) => scaled(middle, command.factor));
      case 'point':
        return this.#point(command.columns, command.rows);
      case 'press':
        this.#stage()?.press();
        return true;
      default:
        return this.#onTool(command);
    }
  }

  #onTool(command: TracingCommand): boolean {
    const { store } = this.#services;
    switch (command.what) {
      case 'size':
        return this.#size(command.steps);
      case 'erase':
        store.setTracing({ erase: !store.ui.tracing.erase });
        return true;
      case 'accept':
        return this.#accept();
      case 'take-back':
        return store.ui.selectedPoint === null && this.#tools.takeBack();
      default:
        return this.#onOutline(command);
    }
  }

  #onOutline(command: TracingCommand): boolean {
    const { store } = this.#services;
    switch (command.what) {
      case 'copy':
        return this.copy(command.step);
      case 'snap':
        return this.snap();
      case 'shape':
        store.show({ popover: store.ui.popover === 'shape' ? null : 'shape' });
        return true;
      case 'all-known':
        return this.#allKnown();
      default:
        return false;
    }
  }

  /** From the nearest traced frame before this one, or after it. */
  copy(step: -1 | 1): boolean {
    const { store } = this.#services;
    const { state, doc, ui } = store;
    const place = currentPlace(state);
    const frame = currentFrame(state);
    if (!place || !frame) return false;
    const index = tracedNeighbour(doc, ui.frameIndex, ui.component, step);
    const { copied, noneBefore, noneAfter, otherSize } = texts.tracing.said;
    const from = index === null ? undefined : doc.frames[index];
    const outline = cellOf(doc, from?.id, ui.component).outline;
    if (!from || !outline) return this.#say((step < 0 ? noneBefore : noneAfter)(texts.component[ui.component]));
    if (from.width !== frame.width || from.height !== frame.height) return this.#say(otherSize(index! + 1));
    store.perform(copyOutline(place, outline, `frame ${index! + 1}`));
    store.show({ selectedPoint: null });
    return this.#say(copied(index! + 1));
  }

  /** Pulls the outline to the edges near it. */
  snap(): boolean {
    const { store, studio } = this.#services;
    const { state, ui } = store;
    const place = currentPlace(state);
    const frame = currentFrame(state);
    const image = frame && studio.imageOf(frame.id);
    const outline = this.#closedOutline();
    if (!place || !outline) return true;
    if (!image) return this.#say(texts.tracing.said.noPixels(frame?.name ?? ''));
    const snapped = snappedOutline(image, outline, ui.tracing.bright !== true, ui.tracing.reach);
    const { greatest, rms } = snapped;
    if (snapped.points.length === 0 || greatest === 0) {
      store.sayAt(place, 'info', texts.tracing.said.noEdge);
      return true;
    }
    // Where an edge bends more sharply than the outline, points pass each other.
    const { points, unknownSides } = withoutLoops(snapped);
    store.perform(setOutline(place, texts.steps.snapOutline, { points, closed: true, unknownSides, laidBy: 'tool' }));
    store.show({ selectedPoint: null });
    const isCut = points !== snapped.points;
    return this.#say(texts.tracing.said.snapped(greatest.toFixed(1), rms.toFixed(2), isCut));
  }

  #allKnown(): boolean {
    const { store } = this.#services;
    const place = currentPlace(store.state);
    if (!place || currentCell(store.state).outline?.unknownSides.length === 0) return false;
    store.perform(markAllKnown(place));
    return this.#say(texts.tracing.said.allKnown);
  }

  /** With Edit points the selected point, with its own tool the outline. */
  #move(columns: number, rows: number): boolean {
    const { store } = this.#services;
    const { tool, selectedPoint } = store.ui;
    if (tool === 'transform') return this.#transform(() => moved(columns, rows));
    const place = currentPlace(store.state);
    const point = selectedPoint === null ? undefined : currentCell(store.state).outline?.points[selectedPoint];
    if (!place || selectedPoint === null || !point) return false;
    const command = movePoint(place, selectedPoint, framePoint(point.column + columns, point.row + rows));
    store.perform({ ...command, mergeKey: `nudge point ${selectedPoint} ${place.frameId} ${place.component}` });
    return true;
  }

  #transform(similarity: (middle: ReturnType<typeof middleOf>) => Similarity): boolean {
    const { store } = this.#services;
    const place = currentPlace(store.state);
    const bounds = boundsOf(currentCell(store.state).outline?.points ?? []);
    if (!place || !bounds) return false;
    store.perform(nudgeOutline(place, similarity(middleOf(bounds))));
    return true;
  }

  /** While a region is adjusted up and down move its level. */
  #point(columns: number, rows: number): boolean {
    const { tool, thresholdLevel } = this.#services.store.ui;
    if (tool === 'threshold' && thresholdLevel && rows !== 0) return this.#tools.stepLevel(-rows);
    this.#stage()?.point(columns, rows);
    return true;
  }

  #size(steps: number): boolean {
    const { store } = this.#services;
    const { tool, tracing } = store.ui;
    if (tool === 'threshold') return this.#tools.stepLevel(steps);
    if (tool !== 'brush') return false;
    const radius = tracing.radius + steps * Math.max(1, Math.round(tracing.radius / 8));
    store.setTracing({ radius: Math.min(RADIUS.most, Math.max(RADIUS.least, radius)) });
    return true;
  }

  /** Enter: the wire closes along the edge, a region that was taken is done with. */
  #accept(): boolean {
    const { store } = this.#services;
    if (store.ui.tool === 'wire') return this.#tools.closeWire();
    if (!store.ui.thresholdLevel) return false;
    store.show({ tool: 'edit', thresholdLevel: null });
    return true;
  }

  #closedOutline(): Outline | null {
    const { outline } = currentCell(this.#services.store.state);
    if (outline?.closed) return outline;
    this.#say(texts.tracing.said.closedFirst);
    return null;
  }

  #say(sentence: string): true {
    this.#services.store.say('info', sentence);
    return true;
  }
}
