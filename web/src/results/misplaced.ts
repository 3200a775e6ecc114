import type { Doc } from '../document/types';
import type { ShapeKind } from '../geometry/shape_kind';
import { COMPONENT_NAMES, otherThan, type ComponentName } from '../terms/component';

/** What the shape of a model tells; null where it tells nothing, or the model is not at hand. */
export type KindOf = (sha256: string) => ShapeKind | null;

const SHAPES: Readonly<Record<ComponentName, ShapeKind>> = { femur: 'bow', tibia: 'tray' };

/** The component whose shape a model has; null where it does not tell. */
export function componentShaped(kind: ShapeKind | null): ComponentName | null {
  return COMPONENT_NAMES.find((component) => SHAPES[component] === kind) ?? null;
}

/** Components whose model has the shape of the other one. */
export interface Misplaced {
  readonly components: readonly ComponentName[];
  /** Whether to change the two mends it: the other model is not in its place either, or may not be, or there is none. */
  readonly canSwap: boolean;
}

export function misplacedModels(doc: Doc, kindOf: KindOf): Misplaced {
  const shaped = (component: ComponentName) => {
    const { model } = doc.components[component];
    return model && componentShaped(kindOf(model.sha256));
  };
  const components = COMPONENT_NAMES.filter((component) => shaped(component) === otherThan(component));
  const canSwap = components.length > 0 && components.every((component) => shaped(otherThan(component)) !== otherThan(component));
  return { components, canSwap };
}
