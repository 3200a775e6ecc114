import type { Doc } from '../document/types';
import type { JointNumbers } from './joint_curves';
import { jointTrusts } from './motion';

type Place = readonly [number, number];

/** The line between the lowest points of both condyles in a frame; places as drawn, mm. */
export interface TrayLine {
  /** Of the frame, from 0. */
  readonly index: number;
  readonly medial: Place;
  readonly lateral: Place;
  readonly doubtful: boolean;
}

/** The tray from above, drawn with anterior up and the patient's right at the right: y runs down. */
export interface TrayDrawing {
  readonly border: readonly Place[];
  readonly lines: readonly TrayLine[];
  readonly middle: Place;
  /** Half of what is to be seen, across and along. */
  readonly reach: Place;
  /** 1 where medial is at the right. */
  readonly medialSide: 1 | -1;
}

/** Round the plate, mm. */
const MARGIN = 3;

/** Null where the tray or the side is not known. Frames with numbers that no knee has have no line. */
export function trayOf(doc: Doc, { columns, of, plate, impossible }: JointNumbers): TrayDrawing | null {
  if (plate.length === 0 || doc.side === 'unknown') return null;
  const medialSide = doc.side === 'left' ? 1 : -1;
  const place = (anterior: number, medial: number): Place => [medialSide * medial, -anterior];
  const border: Place[] = [];
  for (let k = 0; k + 1 < plate.length; k += 2) if (Number.isFinite(plate[k])) border.push(place(plate[k]!, plate[k + 1]!));
  const at = (name: string) => columns.indexOf(name);
  const [medialAp, medialAcross, lateralAp, lateralAcross] = [at('medial_ap_mm'), at('medial_across_mm'), at('lateral_ap_mm'), at('lateral_across_mm')];
  const trusts = jointTrusts(doc);
  const lines = doc.frames.flatMap(({ id }, index): TrayLine[] => {
    const row = of.get(id);
    if (!row || impossible.has(id) || !Number.isFinite(row[medialAp]!) || !Number.isFinite(row[lateralAp]!)) return [];
    return [{ index, medial: place(row[medialAp]!, row[medialAcross]!), lateral: place(row[lateralAp]!, row[lateralAcross]!), doubtful: trusts[index]!.doubtful }];
  });
  const all = [...border, ...lines.flatMap(({ medial, lateral }) => [medial, lateral])];
  const range = (axis: 0 | 1) => all.reduce(([low, high], point) => [Math.min(low, point[axis]), Math.max(high, point[axis])], [Infinity, -Infinity]);
  const [[left, right], [top, bottom]] = [range(0), range(1)] as [[number, number], [number, number]];
  return { border, lines, middle: [(left + right) / 2, (top + bottom) / 2], reach: [(right - left) / 2 + MARGIN, (bottom - top) / 2 + MARGIN], medialSide };
}
