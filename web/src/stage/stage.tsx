import { useEffect, useRef } from 'preact/hooks';
import { currentFrame, type State } from '../document/store';
import { titleOf } from '../terms/component';
import { canvasPoint, type CanvasPoint } from '../geometry/points';
import { recentre } from '../geometry/viewport';
import { Controller } from '../interaction/controller';
import type { Input } from '../interaction/machine';
import { wheelZoom } from '../interaction/navigate';
import { Touches } from '../interaction/touch';
import { TOOLS } from '../interaction/tools';
import { texts } from '../texts/texts';
import { useApp, type App } from '../commands/app';
import { EmptyState } from '../steps/open/empty_state';
import { CheckLater } from '../steps/check/check_later';
import { GuideCard } from '../steps/first/guide_card';
import { pointByKey, pressByKey } from './key_pointer';
import { ScaleBar } from './scale_bar';
import { act, cancelGesture, situationOf } from './stage_input';
import { takeModel } from './take_model';
import { StageView } from './stage_view';

/** The frame with everything on it, and the pointer's way into the document. */
export function Stage({ state }: { state: State }) {
  const app = useApp();
  const picture = useRef<HTMLCanvasElement>(null);
  const ink = useRef<HTMLCanvasElement>(null);
  const glass = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (picture.current && ink.current && glass.current) return attach(app, picture.current, ink.current, glass.current);
    return undefined;
  }, [app]);
  const frame = currentFrame(state);
  const { tool, component, overlaysHidden } = state.ui;
  const cursor = overlaysHidden ? 'grab' : (TOOLS.find(({ name }) => name === tool)?.cursor ?? 'default');
  const words = texts.stage;
  const label = frame
    ? words.label(frame.name, state.ui.frameIndex + 1, state.history.present.frames.length, texts.component[component])
    : words.noFrame;
  return (
    <main class="stage" aria-label={words.region}>
      <canvas ref={picture} class="frame-picture" aria-hidden="true" />
      <canvas ref={ink} class="ink" aria-hidden="true" />
      <div ref={glass} class="glass" style={{ cursor }} tabIndex={0} role="application" aria-label={words.canvas(label, titleOf(component))} />
      {frame && <ScaleBar state={state} />}
      {frame && <GuideCard state={state} />}
      {frame && <CheckLater state={state} />}
      {!frame && <EmptyState state={state} />}
      {frame && !app.services.studio.hasFrame(frame.id) && (
        <p class="absent">{words.absent(frame.name)}</p>
      )}
    </main>
  );
}

/** `glass` lies over the frame and what is drawn on it, and feels the pointer. */
function attach(app: App, picture: HTMLCanvasElement, ink: HTMLCanvasElement, glass: HTMLElement): () => void {
  const { store, studio } = app.services;
  const view = new StageView(store, studio, picture, ink);
  view.calibrator = app.calibrator;
  view.edges = app.edges;
  view.tracingTools = app.tracingTools;
  const controller = new Controller();
  app.actions.stage = {
    size: () => view.size,
    viewport: () => view.viewport(store.state),
    busy: () => controller.busy,
    focus: () => glass.focus({ preventScroll: true }),
    cancel: () => cancelGesture(app, view, controller),
    point: (columns, rows) => pointByKey(app, view, controller, { columns, rows }),
    press: () => pressByKey(app, view, controller),
  };
  const stopPointer = attachPointer(app, view, glass, controller);
  const unsubscribe = store.subscribe(() => view.schedule());
  const observer = new ResizeObserver(([entry]) => {
    if (!entry) return;
    const { width, height } = entry.contentRect;
    const { viewport } = store.ui;
    if (viewport) store.show({ viewport: recentre(viewport, view.size, { width, height }) });
    view.resize({ width, height });
    // The scale bar follows.
    store.show({});
  });
  observer.observe(glass);
  return () => {
    observer.disconnect();
    unsubscribe();
    stopPointer();
    app.actions.stage = null;
  };
}

/** Turns DOM events into inputs of the controller, and its effects into changes of the store. */
function attachPointer(
  app: App,
  view: StageView,
  glass: HTMLElement,
  controller: Controller,
): () => void {
  const { store } = app.services;
  const touches = new Touches();
  const pointOf = (event: MouseEvent): CanvasPoint => canvasPoint(event.offsetX, event.offsetY);

  const send = (type: Input['type'], event: MouseEvent) => {
    const situation = situationOf(store, view);
    if (!situation) return;
    const input: Input = { type, at: pointOf(event), button: BUTTONS[event.button] ?? 'primary', alt: event.altKey, shift: event.shiftKey, touch: event instanceof PointerEvent && event.pointerType === 'touch', ctrl: event.ctrlKey };
    act(app, controller, input, situation);
  };
  const hover = (event: MouseEvent) => view.setPointer(pointOf(event));

  const listeners: { [K in keyof HTMLElementEventMap]?: (event: HTMLElementEventMap[K]) => void } = {
    pointerdown: (event) => {
      glass.focus({ preventScroll: true });
      glass.setPointerCapture(event.pointerId);
      event.preventDefault();
      store.quiet();
      if (store.ui.popover && store.ui.popover !== 'shape' && store.ui.popover !== 'calibrate') store.show({ popover: null });
      if (event.pointerType === 'pen') touches.pen();
      const use = event.pointerType === 'touch' ? touches.down(event.pointerId, pointOf(event)) : 'tool';
      if (use === 'view') return cancelGesture(app, view, controller);
      if (use === 'nothing') return;
      send('down', event);
      hover(event);
    },
    pointermove: (event) => {
      const viewport = event.pointerType === 'touch' ? touches.move(event.pointerId, pointOf(event), view.viewport(store.state)) : null;
      if (viewport) return store.show({ viewport });
      send('move', event);
      hover(event);
    },
    pointerup: (event) => {
      if (event.pointerType === 'touch' && touches.up(event.pointerId)) return;
      send('up', event);
      hover(event);
    },
    pointercancel: (event) => {
      if (event.pointerType !== 'touch' || !touches.up(event.pointerId)) send('cancel', event);
    },
    pointerleave: () => {
      app.tracingTools.leave();
      view.setPointer(null);
    },
    dblclick: (event) => {
      if (!takeModel(app, view, pointOf(event))) send('double', event);
    },
    contextmenu: (event) => event.preventDefault(),
    wheel: (event) => {
      event.preventDefault();
      if (!currentFrame(store.state)) return;
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 : 1;
      // With Shift held some systems turn the wheel sideways.
      if (event.shiftKey && app.actions.tracing.run({ what: 'size', steps: -Math.sign(event.deltaY || event.deltaX) })) return;
      store.show({ viewport: wheelZoom(view.viewport(store.state), pointOf(event), event.deltaY * lines) });
      hover(event);
    },
  };
  const entries = Object.entries(listeners) as [string, EventListener][];
  for (const [type, listener] of entries) glass.addEventListener(type, listener, { passive: false });
  return () => {
    for (const [type, listener] of entries) glass.removeEventListener(type, listener);
  };
}

const BUTTONS = ['primary', 'middle', 'secondary'] as const;
