import type { State } from '../document/store';
import type { Doc } from '../document/types';
import { otherThan, type ComponentName } from '../terms/component';

/**
 * Which component a file is for: what the person said, else what its name says, else what its shape tells, else the component
 * that is selected, unless that one has such a file and the other has none.
 */
export function componentFor(
  state: State,
  file: { readonly name: string; readonly component?: ComponentName | undefined },
  isTaken: (component: ComponentName) => boolean,
  shaped: ComponentName | null = null,
): ComponentName {
  const said = componentSaid(file, shaped);
  if (said) return said;
  const selected = state.ui.component;
  const other = otherThan(selected);
  return isTaken(selected) && !isTaken(other) ? other : selected;
}

/** By a person, a name or the shape; null where none of these tells. */
export function componentSaid(file: { readonly name: string; readonly component?: ComponentName | undefined }, shaped: ComponentName | null): ComponentName | null {
  return file.component ?? namedIn(file.name) ?? shaped;
}

/** The component to work on: the selected one, unless nothing is known of its shape and of the other one's it is. */
export function atHand({ components }: Doc, selected: ComponentName): ComponentName {
  const isKnown = (component: ComponentName) => components[component].model !== null || components[component].libraryFile !== null;
  const other = otherThan(selected);
  return !isKnown(selected) && isKnown(other) ? other : selected;
}

function namedIn(name: string): ComponentName | null {
  const femur = /fem/i.test(name);
  const tibia = /tib|tray/i.test(name);
  if (femur === tibia) return null;
  return femur ? 'femur' : 'tibia';
}
