import type { Doc } from '../document/types';
import { COMPONENT_NAMES, otherThan, type ComponentName } from '../terms/component';

/** The component whose shape a model has; null where it does not tell, or the model is not at hand. */
export type ShapeOf = (sha256: string) => ComponentName | null;

/** Components whose model has the shape of the other one. */
export interface Misplaced {
  readonly components: readonly ComponentName[];
  /** Whether to change the two mends it: the other model is not in its place either, or may not be, or there is none. */
  readonly canSwap: boolean;
}

export function misplacedModels(doc: Doc, shapeOf: ShapeOf): Misplaced {
  const shaped = (component: ComponentName) => {
    const { model } = doc.components[component];
    return model && shapeOf(model.sha256);
  };
  const components = COMPONENT_NAMES.filter((component) => shaped(component) === otherThan(component));
  const canSwap = components.length > 0 && components.every((component) => shaped(otherThan(component)) !== otherThan(component));
  return { components, canSwap };
}
