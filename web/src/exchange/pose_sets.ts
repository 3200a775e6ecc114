import type { PoseSets, State } from '../document/store';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';
import { componentFor } from './guess';
import type { Incoming } from './incoming';
import { pathOf } from './paths';

/** Files of poses by what they are for: those that are the only one of their component, and the others by component. */
export interface SortedPoses<F extends Incoming> {
  readonly clear: readonly F[];
  readonly contested: Readonly<Record<ComponentName, readonly F[]>>;
}

/** A component's poses come from one file: of several a person says which. */
export function sortedPoses<F extends Incoming>(state: State, files: readonly F[]): SortedPoses<F> {
  const of = (component: ComponentName) => files.filter((file) => componentFor(state, file, () => false) === component);
  const byComponent = { femur: of('femur'), tibia: of('tibia') };
  const contested = (component: ComponentName) => (byComponent[component].length > 1 ? byComponent[component] : []);
  return {
    clear: COMPONENT_NAMES.flatMap((component) => (byComponent[component].length === 1 ? byComponent[component] : [])),
    contested: { femur: contested('femur'), tibia: contested('tibia') },
  };
}

/** What a person is asked; null where nothing is contested. `open` opens what was chosen. */
export function setsToAsk<F extends Incoming>({ contested }: SortedPoses<F>, open: (files: readonly F[]) => void): PoseSets | null {
  if (COMPONENT_NAMES.every((component) => contested[component].length === 0)) return null;
  const names = (component: ComponentName) => contested[component].map(pathOf);
  return {
    names: { femur: names('femur'), tibia: names('tibia') },
    take: (chosen) =>
      open(
        COMPONENT_NAMES.flatMap((component) => {
          const file = contested[component][chosen[component] ?? -1];
          return file ? [{ ...file, component }] : [];
        }),
      ),
  };
}
