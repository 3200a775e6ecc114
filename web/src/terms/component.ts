export const COMPONENT_NAMES = ['femur', 'tibia'] as const;

export type ComponentName = (typeof COMPONENT_NAMES)[number];

/** The name of a component as a word at the start of a sentence or on a button. */
export function titleOf(component: ComponentName): string {
  return component === 'femur' ? 'Femur' : 'Tibia';
}

/** The joint's other component. */
export function otherThan(component: ComponentName): ComponentName {
  return component === 'femur' ? 'tibia' : 'femur';
}
