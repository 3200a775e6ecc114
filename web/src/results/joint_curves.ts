import type { Doc } from '../document/types';
import type { Convention, CurveName, Over } from '../terms/joint';
import { jointTrusts } from './motion';

/** Numbers of a joint, as far as they are worked out. */
export interface JointNumbers {
  /** Their names, by the core. */
  readonly columns: readonly string[];
  /** Lowest points and lift-off are known. */
  readonly hasPlate: boolean;
  /** By the frame's id, in the order of the columns. */
  readonly of: ReadonlyMap<string, Float64Array>;
  /** Frames that are still being worked out. */
  readonly waiting: number;
}

export const NO_NUMBERS: JointNumbers = { columns: [], hasPlate: false, of: new Map(), waiting: 0 };

/** The core's names of what a curve shows; of two, the medial one comes first. */
export const CURVES: Readonly<Record<CurveName, { readonly columns: readonly string[]; readonly unit: '°' | 'mm' }>> = {
  flexion: { columns: ['flexion_deg'], unit: '°' },
  abduction: { columns: ['abduction_deg'], unit: '°' },
  internal: { columns: ['internal_rotation_deg'], unit: '°' },
  anterior: { columns: ['field_anterior_mm'], unit: 'mm' },
  superior: { columns: ['field_superior_mm'], unit: 'mm' },
  medial: { columns: ['field_medial_mm'], unit: 'mm' },
  gsAnterior: { columns: ['gs_anterior_mm'], unit: 'mm' },
  gsDistraction: { columns: ['gs_distraction_mm'], unit: 'mm' },
  gsLateral: { columns: ['gs_lateral_mm'], unit: 'mm' },
  lowest: { columns: ['medial_ap_mm', 'lateral_ap_mm'], unit: 'mm' },
  liftOff: { columns: ['lift_off_mm'], unit: 'mm' },
};

/** Rotations above, translations below, and the condyles beside them where they are known. */
export function curvesShown(convention: Convention, hasPlate: boolean): readonly CurveName[] {
  const shifts: readonly CurveName[] = convention === 'field' ? ['anterior', 'superior', 'medial'] : ['gsAnterior', 'gsDistraction', 'gsLateral'];
  const beside = (name: CurveName): readonly CurveName[] => (hasPlate ? [name] : []);
  return ['flexion', 'abduction', 'internal', ...beside('lowest'), ...shifts, ...beside('liftOff')];
}

export interface CurvePoint {
  /** Of the frame, from 0. */
  readonly index: number;
  /** Number of the frame, seconds or degrees of flexion. */
  readonly x: number;
  readonly value: number;
  /** One standard deviation; NaN where it is not known. */
  readonly deviation: number;
  readonly doubtful: boolean;
  readonly checked: boolean;
}

/** What a curve runs over; `rate`: frames a second, for time alone. */
export interface Along {
  readonly over: Over;
  readonly rate: number;
}

/** A curve's points, frame by frame. */
export function pointsOf(doc: Doc, numbers: JointNumbers, column: string, along: Along): readonly CurvePoint[] {
  const at = (name: string) => numbers.columns.indexOf(name);
  const [value, deviation, flexion] = [at(column), at(`sd_${column}`), at('flexion_deg')];
  const trusts = jointTrusts(doc);
  return doc.frames.flatMap(({ id }, index) => {
    const row = numbers.of.get(id);
    if (!row || !Number.isFinite(row[value])) return [];
    const x = along.over === 'flexion' ? row[flexion]! : along.over === 'time' ? index / along.rate : index + 1;
    return [{ index, x, value: row[value]!, deviation: row[deviation]!, ...trusts[index]! }];
  });
}

/** From the least to the most that is to be seen, with its bands; of bands that are far wider than usual not all. */
export function rangeOf(points: readonly CurvePoint[]): readonly [number, number] {
  const known = points.map(({ deviation }) => deviation).filter(Number.isFinite).sort((a, b) => a - b);
  const most = 4 * (known[known.length >> 1] ?? 0);
  const reach = ({ deviation }: CurvePoint) => (Number.isFinite(deviation) ? Math.min(deviation, most) : 0);
  let [low, high] = [Infinity, -Infinity];
  for (const point of points) {
    low = Math.min(low, point.value - reach(point));
    high = Math.max(high, point.value + reach(point));
  }
  if (low > high) return [0, 1];
  // Less than this is drawn flat: what is left is noise, mm or degrees.
  const span = Math.max(2, high - low) * 1.08;
  const middle = (low + high) / 2;
  return [middle - span / 2, middle + span / 2];
}
