import type { PoseNumbers } from '../geometry/pose_numbers';

/** The six numbers of a pose as the panel shows them. */
export interface Quantity {
  readonly field: keyof PoseNumbers;
  readonly name: string;
  readonly label: string;
  readonly unit: 'mm' | '°';
  /** While the uncertainty is not known: hundredths in the plane, tenths along the view. */
  readonly decimals: number;
}

export const QUANTITIES: readonly Quantity[] = [
  { field: 'x', name: 'x', label: 'x', unit: 'mm', decimals: 2 },
  { field: 'y', name: 'y', label: 'y', unit: 'mm', decimals: 2 },
  { field: 'z', name: 'z', label: 'z', unit: 'mm', decimals: 1 },
  { field: 'zRot', name: 'z rotation', label: 'z rot', unit: '°', decimals: 2 },
  { field: 'xRot', name: 'x rotation', label: 'x rot', unit: '°', decimals: 2 },
  { field: 'yRot', name: 'y rotation', label: 'y rot', unit: '°', decimals: 2 },
];

/** As a person says it. */
export function unitWord(unit: Quantity['unit']): string {
  return unit === '°' ? 'degrees' : 'mm';
}
