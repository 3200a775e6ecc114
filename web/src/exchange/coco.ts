import { framePoint } from '../geometry/points';
import { parse } from './outline_file';
import type { ProposedItem, ReadOutlines } from '../document/proposal';
import { count, list, missingAs, number, object, ReadError, text, type Reader } from '../document/reader';
import { cellOf, type Doc, type Outline } from '../document/types';
import { COMPONENT_NAMES } from '../terms/component';
import { type Runs, runsOf } from './runs';

/**
 * Outlines in the form of the COCO data set (object detection): images, categories, and annotations whose segmentation
 * is a list of polygons, or a mask in run lengths. COCO's coordinates are ours: the first pixel covers [0, 1) x [0, 1), y grows downwards.
 * What a polygon cannot say (drafts, unknown sides) is left out of what is written, and told.
 */
interface Coco {
  readonly images: readonly CocoImage[];
  readonly categories: readonly { readonly id: number; readonly name: string }[];
  readonly annotations: readonly CocoAnnotation[];
}

interface CocoImage {
  readonly id: number;
  readonly file_name: string;
  readonly width: number;
  readonly height: number;
}

interface CocoAnnotation {
  readonly id: number;
  readonly image_id: number;
  readonly category_id: number;
  readonly segmentation: unknown;
}

export function writeCoco(doc: Doc, program: string): string {
  const categories = COMPONENT_NAMES.map((name, index) => ({ id: index + 1, name, supercategory: 'implant' }));
  const images = doc.frames.map(({ name, width, height }, index) => ({ id: index + 1, file_name: name, width, height }));
  const annotations: object[] = [];
  doc.frames.forEach((frame, index) => {
    for (const { id: category, name } of categories) {
      const { outline } = cellOf(doc, frame.id, name);
      if (outline?.closed) annotations.push({ id: annotations.length + 1, image_id: index + 1, category_id: category, ...shapeOf(outline) });
    }
  });
  return `${JSON.stringify({ info: { description: doc.name, contributor: program }, images, categories, annotations })}\n`;
}

function shapeOf({ points }: Outline): object {
  const [columns, rows] = [points.map(({ column }) => column), points.map(({ row }) => row)];
  const [left, top] = [Math.min(...columns), Math.min(...rows)];
  const box = [left, top, Math.max(...columns) - left, Math.max(...rows) - top];
  const segmentation = [points.flatMap(({ column, row }) => [column, row])];
  return { segmentation, area: areaOf(segmentation[0]!), bbox: box, iscrowd: 0 };
}

/** An item whose outline is still to be found around a mask. */
export interface ProposedRuns {
  readonly item: Omit<ProposedItem, 'outline' | 'exactOutline' | 'notes'>;
  readonly runs: Runs;
}

/** Items for a proposal, masks for others, and sentences about annotations that are neither. */
export function readCoco(json: string): ReadOutlines & { readonly masks: readonly ProposedRuns[] } {
  const { images, categories, annotations } = readFile(parse(json), 'file');
  const imageOf = new Map(images.map((image, order) => [image.id, { image, order }]));
  const nameOf = new Map(categories.map(({ id, name }) => [id, name]));
  const items: ProposedItem[] = [];
  const masks: ProposedRuns[] = [];
  const remarks: string[] = [];
  for (const annotation of annotations) {
    const found = imageOf.get(annotation.image_id);
    const subject = nameOf.get(annotation.category_id);
    const [polygons, runs] = [polygonsOf(annotation.segmentation), runsOf(annotation.segmentation)];
    if (!found) remarks.push(`annotation ${annotation.id} is of image ${annotation.image_id}, which the file does not list`);
    else if (subject === undefined) remarks.push(`annotation ${annotation.id} is of category ${annotation.category_id}, which the file does not list`);
    else if (runs !== null) masks.push({ item: { ...placeOf(annotation, found, images.length, subject), size: { width: runs.width, height: runs.height } }, runs });
    else if (polygons === null) remarks.push(`annotation ${annotation.id} (${found.image.file_name}) has ${Array.isArray(annotation.segmentation) ? 'no polygon of three points or more' : 'run lengths that do not fill its image'}`);
    else items.push(itemOf(placeOf(annotation, found, images.length, subject), polygons));
  }
  return { items: largestFirst(items), masks, remarks };
}

function placeOf({ id }: CocoAnnotation, { image: { file_name: image, width, height }, order }: { readonly image: CocoImage; readonly order: number }, images: number, subject: string): ProposedRuns['item'] {
  const size = width > 0 && height > 0 ? { width, height } : null;
  return { label: `${image}, ${subject} (annotation ${id})`, image, order, images, frameId: null, subject, size };
}

function itemOf(place: ProposedRuns['item'], polygons: readonly number[][]): ProposedItem {
  const largest = polygons.reduce((best, polygon) => (areaOf(polygon) > areaOf(best) ? polygon : best));
  const others = polygons.length - 1;
  return {
    ...place,
    outline: { points: pairs(withoutClosingPoint(largest)), closed: true, unknownSides: [] },
    exactOutline: null,
    notes: others === 0 ? [] : [`${others} smaller ${others === 1 ? 'polygon' : 'polygons'} left out`],
  };
}

/** Of several outlines for one cell the first is taken: let that be the largest. */
export function largestFirst(items: readonly ProposedItem[]): readonly ProposedItem[] {
  const area = ({ outline }: ProposedItem) => areaOf(outline.points.flatMap(({ column, row }) => [column, row]));
  return [...items].sort((a, b) => a.order - b.order || area(b) - area(a));
}

/** Null where there is no polygon. */
function polygonsOf(segmentation: unknown): readonly number[][] | null {
  if (!Array.isArray(segmentation)) return null;
  const polygons = segmentation.filter(
    (polygon): polygon is number[] =>
      Array.isArray(polygon) && polygon.length >= 6 && polygon.length % 2 === 0 && polygon.every((value) => Number.isFinite(value)),
  );
  return polygons.length > 0 ? polygons : null;
}

/** Some programs repeat the first point at the end. */
function withoutClosingPoint(polygon: readonly number[]): readonly number[] {
  const repeated = polygon.length > 6 && polygon[0] === polygon.at(-2) && polygon[1] === polygon.at(-1);
  return repeated ? polygon.slice(0, -2) : polygon;
}

function pairs(polygon: readonly number[]) {
  return Array.from({ length: polygon.length / 2 }, (_, at) => framePoint(polygon[2 * at]!, polygon[2 * at + 1]!));
}

/** Square px, by the shoelace formula. */
function areaOf(polygon: readonly number[]): number {
  let twice = 0;
  for (let at = 0; at < polygon.length; at += 2) {
    const next = (at + 2) % polygon.length;
    twice += polygon[at]! * polygon[next + 1]! - polygon[next]! * polygon[at + 1]!;
  }
  return Math.abs(twice) / 2;
}

// --- Reading ------------------------------------------------------------------------------------------------------

const anything: Reader<unknown> = (value) => value ?? null;

const readImage = object<CocoImage>({ id: number, file_name: text, width: missingAs(0, count), height: missingAs(0, count) });

const readFile: Reader<Coco> = (value, path) => {
  const { images, categories, annotations } = object<Coco>({
    images: list(readImage),
    categories: list(object({ id: number, name: text })),
    annotations: list(object<CocoAnnotation>({ id: missingAs(0, number), image_id: number, category_id: number, segmentation: anything })),
  })(value, path);
  if (annotations.length === 0) throw new ReadError('there are no annotations in it');
  return { images, categories, annotations };
};
