/** Units of length that a model's file may be written in, as `study.toml` names them, with the millimetres in one. */
export const UNITS_MM = { mm: 1, cm: 10, m: 1000, in: 25.4 } as const;

export type LengthUnit = keyof typeof UNITS_MM;

export const LENGTH_UNITS = Object.keys(UNITS_MM) as readonly LengthUnit[];

/** Undefined where no unit has so many. */
export function unitOf(mm: number): LengthUnit | undefined {
  return LENGTH_UNITS.find((unit) => UNITS_MM[unit] === mm);
}
