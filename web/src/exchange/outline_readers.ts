import type { ProposedItem, ReadOutlines } from '../document/proposal';
import type { Outline } from '../document/types';
import { framePoint } from '../geometry/points';
import { sentenceOf } from '../jobs/services';
import { later } from '../texts/later';
import type { MaskLabel } from '../workers/protocol/masks';
import { masksWorker } from '../workers/start';
import { largestFirst, type ProposedRuns, readCoco } from './coco';
import { readRegions } from './imagej';
import { bytesOf, type Incoming, textOf } from './incoming';
import { readLabelme } from './labelme';
import { readOutlines } from './outline_file';
import { pathOf } from './paths';
import { maskOfRuns } from './runs';

/** Files of outlines: ours, and those of other programs. */
export type OutlineKind = 'outlines' | 'coco' | 'labelme' | 'imagej';

/** How far a simplified outline may leave the middle of a mask's border, px: less than the border is known by. */
export const TOLERANCE = 0.4;

/** What all files hold; one that cannot be read is told. */
export async function readOutlineFiles(files: readonly (Incoming & { readonly kind: OutlineKind })[]): Promise<ReadOutlines> {
  const items: ProposedItem[] = [];
  const remarks: string[] = [];
  for (const file of files) {
    // Those of which a file is for one image.
    const images = files.filter(({ kind }) => kind === file.kind);
    try {
      const read = await readOne(file, { order: images.indexOf(file), images: images.length });
      items.push(...read.items);
      remarks.push(...read.remarks.map((remark) => `${pathOf(file)}: ${remark}`));
    } catch (error) {
      remarks.push(`${pathOf(file)}: ${sentenceOf(error)}`);
    }
  }
  return { items, remarks };
}

async function readOne(file: Incoming & { readonly kind: OutlineKind }, place: Pick<ProposedItem, 'order' | 'images'>): Promise<ReadOutlines> {
  switch (file.kind) {
    case 'outlines':
      return { items: readOutlines(await textOf(file)), remarks: [] };
    case 'coco':
      return traced(readCoco(await textOf(file)));
    case 'labelme':
      return readLabelme(await textOf(file), file.name, place);
    case 'imagej':
      return readRegions(await bytesOf(file.blob), file.name, place.order);
  }
}

/** With outlines around the masks among the annotations. */
async function traced({ items, masks, remarks }: ReturnType<typeof readCoco>): Promise<ReadOutlines> {
  if (masks.length === 0) return { items, remarks };
  const worker = masksWorker();
  try {
    const all: ProposedItem[] = [...items];
    const empty: string[] = [];
    for (const { item, runs } of masks) {
      const { width, height } = runs;
      const label = await worker.call('trace', { inside: maskOfRuns(runs), width, height, tolerance: TOLERANCE });
      if (label) all.push(itemOfMask(item, label));
      else empty.push(later.exchange.emptyMask(item.label));
    }
    return { items: largestFirst(all), remarks: [...remarks, ...empty] };
  } finally {
    worker.dispose();
  }
}

/** Where an outline belongs, with the outline of a mask. */
export function itemOfMask(item: ProposedRuns['item'], label: MaskLabel): ProposedItem {
  return { ...item, outline: closed(label.points), exactOutline: closed(label.exact), notes: notesOf(label) };
}

function notesOf({ specks, holes, differing, area }: MaskLabel): string[] {
  const { exchange } = later;
  const fraction = (100 * differing) / Math.max(1, area);
  return [
    specks > 0 ? exchange.specks(specks) : null,
    specks > area ? exchange.mostlySpecks : null,
    holes > 0 ? exchange.holes(holes) : null,
    fraction >= 0.5 ? exchange.differing(fraction.toFixed(1)) : null,
  ].filter((note) => note !== null);
}

function closed(numbers: Float64Array): Outline {
  const points = Array.from({ length: numbers.length / 2 }, (_, at) => framePoint(numbers[2 * at]!, numbers[2 * at + 1]!));
  return { points, closed: true, unknownSides: [] };
}
