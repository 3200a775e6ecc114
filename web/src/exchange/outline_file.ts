import { framePoint, type FramePoint } from '../geometry/points';
import type { ProposedItem } from '../document/proposal';
import { count, flag, list, missingAs, number, object, oneOf, optional, ReadError, text, type Reader } from '../document/reader';
import { cellOf, type Doc, LAID_BY, type LaidBy, type Outline } from '../document/types';
import { COMPONENT_NAMES, type ComponentName } from '../terms/component';

/**
 * Outlines in a file of our own, for other programs: JSON in UTF-8.
 *
 *     { "kind": "fluoropose-outlines", "version": 1, "program": "fluoropose 0.1.0",
 *       "frames": [ { "id": "9f86d081884c7d65:0", "name": "0001.png", "width": 1024, "height": 1024,
 *                     "outlines": [ { "component": "femur", "closed": true, "unknownSides": [3],
 *                                     "points": [[412.5, 300.25], ...] } ] } ] }
 *
 * A point is column and row in pixels; the first pixel of the frame covers [0, 1) x [0, 1), rows grow downwards. Side
 * `i` runs from point `i` to the next, the last back to the first. `id` is the first 16 digits of the SHA-256 of the
 * file that holds the frame, a colon, and the frame's number in it from 0. An outline that is not closed is a draft. `laidBy` is
 * `tool` where a tool laid the outline on the frame's edges, `mixed` where it did so in part, `mask` where it came of a mask from which the frame
 * is to be looked at, `click` for the model's silhouette where one click found it, and missing where a hand laid it.
 */
export const OUTLINES_KIND = 'fluoropose-outlines';
export const OUTLINES_VERSION = 1;

interface FileFrame {
  readonly id: string;
  readonly name: string;
  readonly width: number;
  readonly height: number;
  readonly outlines: readonly FileOutline[];
}

interface FileOutline {
  readonly component: ComponentName;
  readonly closed: boolean;
  readonly unknownSides: readonly number[];
  readonly laidBy?: LaidBy;
  readonly points: readonly (readonly [number, number])[];
}

export function writeOutlines(doc: Doc, program: string): string {
  const frames = doc.frames.map(({ id, name, width, height }): FileFrame => {
    const outlines = COMPONENT_NAMES.flatMap((component) => {
      const { outline } = cellOf(doc, id, component);
      return outline ? [plain(component, outline)] : [];
    });
    return { id, name, width, height, outlines };
  });
  const withOutlines = frames.filter(({ outlines }) => outlines.length > 0);
  return `${JSON.stringify({ kind: OUTLINES_KIND, version: OUTLINES_VERSION, program, frames: withOutlines })}\n`;
}

function plain(component: ComponentName, { closed, unknownSides, laidBy, points }: Outline): FileOutline {
  return { component, closed, unknownSides, ...(laidBy && { laidBy }), points: points.map(({ column, row }) => [column, row] as const) };
}

/** Items for a proposal; throws a sentence that names the place at fault. */
export function readOutlines(json: string): readonly ProposedItem[] {
  const value = parse(json);
  const { kind, version } = object({ kind: text, version: count })(value, 'file');
  if (kind !== OUTLINES_KIND) throw new ReadError(`this JSON holds no outlines (its "kind" is "${kind}")`);
  if (version !== OUTLINES_VERSION) {
    throw new ReadError(`these outlines have version ${version}; this page reads version ${OUTLINES_VERSION}: open them with a newer page`);
  }
  const { frames } = object({ frames: list(readFrame) })(value, 'file');
  return frames.flatMap((frame, order) => frame.outlines.map((outline) => itemOf(frame, order, outline)));
}

function itemOf(frame: FileFrame, order: number, outline: FileOutline): ProposedItem {
  const { id, name, width, height } = frame;
  const { component, closed, unknownSides, laidBy, points } = outline;
  const placed: FramePoint[] = points.map(([column, row]) => framePoint(column, row));
  return {
    label: `${name}, ${component}`,
    image: name,
    order,
    images: null,
    frameId: id,
    subject: component,
    size: { width, height },
    outline: { closed, unknownSides, ...(laidBy && { laidBy }), points: placed },
    exactOutline: null,
    notes: closed ? [] : ['a draft'],
  };
}

const readPair: Reader<readonly [number, number]> = (value, path) => {
  const [column, row, ...rest] = list(number)(value, path);
  if (column === undefined || row === undefined || rest.length > 0) throw new ReadError(`${path} should be a pair of numbers, column and row`);
  return [column, row];
};

const readOutline: Reader<FileOutline> = (value, path) => {
  const { laidBy } = object({ laidBy: optional(oneOf(...LAID_BY)) })(value, path);
  const outline = object<Omit<FileOutline, 'laidBy'>>({
    component: oneOf('femur', 'tibia'),
    closed: flag,
    unknownSides: missingAs<readonly number[]>([], list(count)),
    points: list(readPair),
  })(value, path);
  const beyond = outline.unknownSides.find((side) => side >= outline.points.length);
  if (beyond !== undefined) throw new ReadError(`${path}.unknownSides names side ${beyond} of ${outline.points.length}`);
  return { ...outline, ...(laidBy !== null && { laidBy }) };
};

const readFrame: Reader<FileFrame> = object<FileFrame>({ id: text, name: text, width: count, height: count, outlines: list(readOutline) });

export function parse(json: string): unknown {
  try {
    return JSON.parse(json);
  } catch (error) {
    throw new ReadError(`it is cut short or damaged (${(error as Error).message})`);
  }
}
