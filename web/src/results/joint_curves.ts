import type { Doc } from '../document/types';
import type { Convention, CurveName, Over } from '../terms/joint';
import { jointTrusts, runsOf } from './motion';

/** Numbers of a joint, as far as they are worked out. */
export interface JointNumbers {
  /** Their names, by the core. */
  readonly columns: readonly string[];
  /** Lowest points and lift-off are known. */
  readonly hasPlate: boolean;
  /** The border of the tray's plate from above: anterior and medial place of each point, mm; empty where there is none. */
  readonly plate: Float64Array;
  /** What the femur's flange says of the side of the body, where it tells the other one: a sentence without its full stop. */
  readonly otherSide: string | null;
  /** By the frame's id, in the order of the columns, and what the core needs again behind them. */
  readonly of: ReadonlyMap<string, Float64Array>;
  /** By the frame's id: why no knee has one of its numbers. */
  readonly impossible: ReadonlyMap<string, string>;
  /** A translation, mm, of the first frame whose translations are no knee's because the origin of a model's file lies far off its component. */
  readonly originsApart: number | null;
  /** Frames that are still being worked out. */
  readonly waiting: number;
}

export const NO_NUMBERS: JointNumbers = { columns: [], hasPlate: false, plate: new Float64Array(), otherSide: null, of: new Map(), impossible: new Map(), originsApart: null, waiting: 0 };

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
  /** No knee has the numbers of this frame: it is not drawn, and no axis reaches to it. */
  readonly impossible: boolean;
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
    return [{ index, x, value: row[value]!, deviation: row[deviation]!, ...trusts[index]!, impossible: numbers.impossible.has(id) }];
  });
}

/** The point of a frame, if it has one; points are in the order of frames. */
export function pointAt(points: readonly CurvePoint[], index: number): CurvePoint | undefined {
  let [low, high] = [0, points.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (points[middle]!.index < index) low = middle + 1;
    else high = middle;
  }
  return points[low]?.index === index ? points[low] : undefined;
}

/** Numbers that differ by more from frame to frame, degrees or mm, are joined by no line: an angle that passed half a turn, or a wrong pose. */
const JUMP = 45;

/** What one line is drawn through: frames that follow each other, that a knee can have, and between which nothing jumps. */
export function linesOf(points: readonly CurvePoint[]): readonly (readonly CurvePoint[])[] {
  const possible = points.filter(({ impossible }) => !impossible);
  return runsOf(possible, (a, b) => Math.abs(a.value - b.value) <= JUMP);
}

/** What is told of numbers that no knee has: each sentence once, with its frames, from 1. */
export function impossibilitiesOf(doc: Doc, { impossible }: JointNumbers): readonly { readonly why: string; readonly frames: readonly number[] }[] {
  const told = new Map<string, number[]>();
  doc.frames.forEach(({ id }, index) => {
    const why = impossible.get(id);
    // Frames differ in the number alone.
    const kind = why?.replace(/-?\d+/g, '');
    if (!why || kind === undefined) return;
    const known = [...told.keys()].find((other) => other.replace(/-?\d+/g, '') === kind);
    told.set(known ?? why, [...(told.get(known ?? why) ?? []), index + 1]);
  });
  return [...told].map(([why, frames]) => ({ why, frames }));
}

/** From the least to the most that is to be seen, with its bands; of bands that are far wider than usual not all. */
export function rangeOf(all: readonly CurvePoint[]): readonly [number, number] {
  const points = all.filter(({ impossible }) => !impossible);
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
