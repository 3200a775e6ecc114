import { count, list, nullable, number, object, oneOf, ReadError, text, type Reader } from './reader';

/**
 * A correction of distortion: two polynomials that take a place in a frame as it was taken to where it lies in the
 * undistorted one. It is applied to the frames, which are then shown so, or to the outlines alone, which stay where
 * they were traced and are undistorted when a pose is worked out.
 */
export interface Distortion {
  /** The file that the grid was in, for people. */
  readonly name: string;
  readonly appliesTo: 'frames' | 'outlines';
  readonly order: number;
  /** Of the frames that it is for, px. */
  readonly width: number;
  readonly height: number;
  /** What the polynomials count from, column and row, px, and their unit, px. */
  readonly centre: readonly number[];
  readonly scale: number;
  /** Coefficients of 1, x, y, x^2, xy, y^2, x^3 ... to the fifth order. */
  readonly column: readonly number[];
  readonly row: readonly number[];
  readonly quality: DistortionQuality;
}

/** Root mean squares in px. */
export interface DistortionQuality {
  readonly beads: number;
  readonly dropped: number;
  readonly before: number;
  readonly after: number;
  /** With each bead left out of its own fit, for orders 3, 4, 5; null where there are too few beads. */
  readonly leftOut: readonly (number | null)[];
  readonly largestShift: number;
}

const TERMS = 21;
const HEAD = 6;

/** As the core takes them. */
export function numbersOf({ order, width, height, centre, scale, column, row }: Distortion): Float64Array<ArrayBuffer> {
  return Float64Array.of(order, width, height, ...centre, scale, ...column, ...row);
}

export function distortionOf(
  numbers: ArrayLike<number>,
  named: Pick<Distortion, 'name' | 'appliesTo' | 'quality'>,
): Distortion {
  const all = Array.from(numbers);
  const [order = 3, width = 1, height = 1, column = 0, row = 0, scale = 1] = all;
  const polynomials = { column: all.slice(HEAD, HEAD + TERMS), row: all.slice(HEAD + TERMS, HEAD + 2 * TERMS) };
  return { ...named, order, width, height, centre: [column, row], scale, ...polynomials };
}

/** Two corrections with the same key do the same to frames and outlines. */
export function distortionKey(distortion: Distortion | null): string {
  return distortion === null ? '' : `${distortion.appliesTo} ${Array.from(numbersOf(distortion)).join(' ')}`;
}

export function fits(distortion: Distortion | null, size: { readonly width: number; readonly height: number }): distortion is Distortion {
  return distortion !== null && distortion.width === size.width && distortion.height === size.height;
}

// --- Files ----------------------------------------------------------------------------------------------------------

export const DISTORTION_KIND = 'fluoropose-distortion';
const VERSION = 1;

function listOf(length: number): Reader<readonly number[]> {
  return (value, path) => {
    const values = list(number)(value, path);
    if (values.length !== length) throw new ReadError(`${path} should hold ${length} numbers but holds ${values.length}`);
    return values;
  };
}

export const readDistortion = object<Distortion>({
  name: text,
  appliesTo: oneOf('frames', 'outlines'),
  order: count,
  width: count,
  height: count,
  centre: listOf(2),
  scale: number,
  column: listOf(TERMS),
  row: listOf(TERMS),
  quality: object<DistortionQuality>({
    beads: count,
    dropped: count,
    before: number,
    after: number,
    leftOut: list(nullable(number)),
    largestShift: number,
  }),
});

export function writeDistortionFile(distortion: Distortion): string {
  return `${JSON.stringify({ kind: DISTORTION_KIND, version: VERSION, ...distortion }, null, 1)}\n`;
}

export function readDistortionFile(json: string): Distortion {
  let value: unknown;
  try {
    value = JSON.parse(json);
  } catch (error) {
    throw new ReadError(`the correction of distortion is cut short or damaged (${(error as Error).message})`);
  }
  const { kind, version } = object({ kind: text, version: count })(value, 'file');
  if (kind !== DISTORTION_KIND) throw new ReadError(`this is no correction of distortion (its kind is "${kind}")`);
  if (version !== VERSION) throw new ReadError(`this correction has version ${version}; this page reads version ${VERSION}`);
  return readDistortion(value, 'file');
}
