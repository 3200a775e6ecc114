import { useEffect } from 'preact/hooks';
import { type Action, actionFor, type KeyInput } from '../commands/bindings';
import { runCheckKey } from '../commands/check_keys';
import { texts } from '../texts/texts';
import { useApp, useAppState } from '../commands/app';
import { later } from '../commands/later';
import { useDropTarget } from '../steps/open/drop';
import { runHandOrSeeingKey } from './hand_keys';
import { Popovers } from './popovers';
import { Rail } from './rail';
import { JointDock } from '../steps/joint/joint_dock';
import { Stage } from '../stage/stage';
import { StatusLine } from './status_line';
import { Timeline } from '../strip/timeline';
import { ToolStrip } from './tool_strip';
import { TopBar } from './top_bar';

/** Wanted with the first frame. */
const Panel = later(async () => (await import('./panel')).Panel);

export function Page() {
  const state = useAppState();
  const dropping = useDropTarget();
  const { actions } = useApp();
  useKeys();
  // Before there is a frame there is nothing to do it with, and a button that asks once more keeps the focus.
  const empty = state.history.present.frames.length === 0;
  // The mouse leaves the keyboard with the frame; who works by keyboard keeps the focus where it is.
  const giveBack = (event: MouseEvent) => {
    const target = event.target instanceof Element ? event.target.closest('button, input[type=range]') : null;
    const elsewhere = target?.closest('[role=dialog]') || target?.hasAttribute('aria-haspopup');
    if (target && !empty && !elsewhere && event.detail > 0) actions.stage?.focus();
  };
  useEffect(() => {
    // What had the focus is gone with the empty page.
    if (!empty && (document.activeElement === null || document.activeElement === document.body)) actions.stage?.focus();
  }, [empty]);
  return (
    <div class={['page', dropping ? 'dropping' : '', empty ? 'empty-page' : ''].filter(Boolean).join(' ')} data-drop={texts.stage.drop} onClick={giveBack}>
      <TopBar state={state} />
      {!empty && <Rail state={state} />}
      {!empty && <ToolStrip state={state} />}
      <Stage state={state} />
      {!empty && <Panel state={state} />}
      {!empty && <Timeline state={state} />}
      {!empty && <JointDock state={state} />}
      <StatusLine state={state} />
      <Popovers state={state} />
    </div>
  );
}

/** Keys for the whole page; a field that is being typed in keeps its own. */
function useKeys(): void {
  const app = useApp();
  const { actions, services } = app;
  useEffect(() => {
    const { store } = services;
    // Left and right change frames until the other arrows, or Shift, have taken the pointer from the mouse.
    let pointsByKeys = false;
    const onMove = () => (pointsByKeys = false);
    const meant = (input: KeyInput) => {
      const action = actionFor(input, store.ui.tool);
      if (action?.name !== 'tracing' || action.command.what !== 'point') return action;
      if (pointsByKeys || input.shift || action.command.rows !== 0 || actions.stage?.busy()) pointsByKeys = true;
      return pointsByKeys ? action : actionFor(input);
    };
    const onDown = (event: KeyboardEvent) => {
      if (event.key === ' ' && !typing(event.target) && !onControl(event.target)) {
        event.preventDefault();
        if (!store.ui.overlaysHidden) store.show({ overlaysHidden: true });
        return;
      }
      if (handle(event)) event.preventDefault();
    };
    const onUp = (event: KeyboardEvent) => {
      if (event.key === ' ' && store.ui.overlaysHidden) store.show({ overlaysHidden: false });
    };
    const onBlur = () => store.ui.overlaysHidden && store.show({ overlaysHidden: false });
    const handle = (event: KeyboardEvent): boolean => {
      const { key, ctrlKey, metaKey, shiftKey: shift, altKey: alt, target, repeat } = event;
      if (!typing(target) && !inSheet(target) && !repeat && runCheckKey(app, { key, ctrl: ctrlKey || metaKey, shift, alt })) return true;
      if (runHandOrSeeingKey(app, event, { typing: typing(target), onControl: onControl(target), inSheet: inSheet(target) })) return true;
      const action = meant({ key, ctrl: ctrlKey || metaKey, shift, alt });
      if (!action) return false;
      // Who holds a key down too long would say yes to cells that nobody saw.
      if (repeat && !isRepeated(action)) return !typing(target);
      const everywhere = action.name === 'save' || action.name === 'open' || action.name === 'leave';
      if (typing(target) && !everywhere) return false;
      if (inSheet(target) && isOfCell(action, key)) return false;
      // Enter belongs to the control that has the focus.
      if (onControl(target) && (action.name === 'close-outline' || (action.name === 'tracing' && /^(Enter|Arrow)/.test(key)))) return false;
      if (target instanceof HTMLInputElement && target.type === 'range' && key.startsWith('Page')) return false;
      if (/-frame$/.test(action.name) && key.startsWith('Arrow') && hasArrows(target)) return false;
      store.quiet();
      return actions.run(action);
    };
    window.addEventListener('keydown', onDown);
    window.addEventListener('keyup', onUp);
    window.addEventListener('pointermove', onMove);
    window.addEventListener('blur', onBlur);
    return () => {
      window.removeEventListener('keydown', onDown);
      window.removeEventListener('keyup', onUp);
      window.removeEventListener('pointermove', onMove);
      window.removeEventListener('blur', onBlur);
    };
  }, [app, actions, services]);
}

/** What moves by arrows itself: sliders, groups of which one is chosen, pictures that turn. */
function hasArrows(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.matches('input, [role]:not([role="application"])');
}

function typing(target: EventTarget | null): boolean {
  if (target instanceof HTMLInputElement) return target.type !== 'range' && target.type !== 'checkbox';
  return target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement;
}

/** In a sheet that is not about the cell on view; the list of what there is to do is. */
function inSheet(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.closest('.sheet:not(.work-sheet)') !== null;
}

/** What a person says of the cell, or does to it: nobody means it who looks at something else, where arrows scroll. */
function isOfCell(action: Action, key: string): boolean {
  if (action.name === 'work') return ['toggle-checked', 'toggle-flagged', 'start-anew'].includes(action.command);
  if (action.name === 'tracing' || /^(Arrow|Page)/.test(key)) return true;
  return ['delete-point', 'delete-outline', 'other-candidate', 'close-outline', 'toggle-unknown'].includes(action.name);
}

/** What goes on while its key is held. */
function isRepeated(action: Action): boolean {
  if (action.name === 'tracing') return ['move', 'turn', 'scale', 'point', 'size', 'take-back'].includes(action.command.what);
  return /^(undo|redo|zoom-in|zoom-out|(previous|next)-(frame|point))$/.test(action.name);
}

function onControl(target: EventTarget | null): boolean {
  return target instanceof HTMLElement && target.closest('button, input, select, textarea, a') !== null;
}
