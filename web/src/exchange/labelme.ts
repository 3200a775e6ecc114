import { framePoint } from '../geometry/points';
import type { ProposedItem, ReadOutlines } from '../document/proposal';
import { count, list, missingAs, number, object, optional, ReadError, text, type Reader } from '../document/reader';
import { fileName } from './paths';
import { parse } from './outline_file';

/** Outlines in the form of labelme: a file for each image. Its coordinates are ours. */
interface Labelme {
  readonly shapes: readonly Shape[];
  readonly imagePath: string | null;
  readonly imageWidth: number | null;
  readonly imageHeight: number | null;
}

interface Shape {
  readonly label: string;
  readonly shape_type: string;
  readonly points: readonly (readonly number[])[];
}

/** Items for a proposal, of the image that has this place among those of its kind, and sentences about shapes that are no polygons. */
export function readLabelme(json: string, file: string, place: Pick<ProposedItem, 'order' | 'images'>): ReadOutlines {
  const { shapes, imagePath, imageWidth, imageHeight } = readFile(parse(json), 'file');
  if (shapes.length === 0) throw new ReadError('there are no shapes in it');
  const image = imagePath === null ? file : fileName(imagePath);
  const size = imageWidth && imageHeight ? { width: imageWidth, height: imageHeight } : null;
  const items: ProposedItem[] = [];
  const remarks: string[] = [];
  for (const { label, shape_type, points } of shapes) {
    if (shape_type !== 'polygon' || points.length < 3) {
      remarks.push(`"${label}" is a ${shape_type} of ${points.length} points: only polygons are read`);
      continue;
    }
    const outline = { points: points.map(([column, row]) => framePoint(column!, row!)), closed: true, unknownSides: [] };
    items.push({ label: `${image}, ${label}`, image, ...place, frameId: null, subject: label, size, outline, exactOutline: null, notes: [] });
  }
  return { items, remarks };
}

const readPair: Reader<readonly number[]> = (value, path) => {
  const pair = list(number)(value, path);
  if (pair.length !== 2) throw new ReadError(`${path} should be a pair of numbers, column and row`);
  return pair;
};

const readFile: Reader<Labelme> = object<Labelme>({
  shapes: list(object<Shape>({ label: text, shape_type: missingAs('polygon', text), points: list(readPair) })),
  imagePath: optional(text),
  imageWidth: optional(count),
  imageHeight: optional(count),
});
