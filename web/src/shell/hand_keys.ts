import { handActionFor } from '../commands/hand_bindings';
import { seeingActionFor } from '../commands/seeing_bindings';
import type { App } from '../commands/app';

interface Focus {
  /** A field that is being typed in has the keyboard. */
  readonly typing: boolean;
  /** A button or the like has it. */
  readonly onControl: boolean;
  /** A sheet that is not about the cell on view has it. */
  readonly inSheet: boolean;
}

/** Keys of a model in hand, and of how things are shown. False where the key means neither. */
export function runHandOrSeeingKey({ hand, seeing, services, actions }: App, event: KeyboardEvent, focus: Focus): boolean {
  if (focus.typing) return false;
  const { key, ctrlKey, metaKey, shiftKey: shift, altKey: alt } = event;
  const input = { key, ctrl: ctrlKey || metaKey, shift, alt };
  const adjusting = services.store.ui.tool === 'pose' && !focus.inSheet ? handActionFor(input) : null;
  // Enter and arrows belong to the control that has the focus.
  if (adjusting && !(focus.onControl && (key === 'Enter' || ownsArrows(event.target, key)))) {
    if (actions.stage?.busy()) return true;
    services.store.quiet();
    return hand.run(adjusting, event.repeat);
  }
  const action = seeingActionFor(input);
  return action !== null && seeing.run(action);
}

/** Sliders, and pictures that are walked through with arrows. */
function ownsArrows(target: EventTarget | null, key: string): boolean {
  return key.startsWith('Arrow') && target instanceof HTMLElement && target.closest('input, [data-arrows]') !== null;
}
