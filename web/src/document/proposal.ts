import { cellOf, type Doc, type FrameEntry, type Outline } from './types';
import type { ComponentName } from '../terms/component';

/**
 * Outlines that came from files and wait for a person's word on which frame and component each is for. Nothing of the
 * document changes before that.
 */
export interface Proposal {
  readonly items: readonly ProposedItem[];
  /** Names of what the files say an outline is of (a category, a folder, a grey value), and the component meant by it. */
  readonly subjects: Readonly<Record<string, ComponentName | null>>;
  readonly match: FrameMatching;
  /** Masks: every pixel as it is, instead of few points. */
  readonly exact: boolean;
  /** Masks: poses begin from them, and the frames' edges decide. */
  readonly onFrames: boolean;
  /** Opens the files as frames after all; null where they cannot be frames. */
  readonly asFrames: (() => void) | null;
  /** What did not go smoothly on the way, a sentence each. */
  readonly remarks: readonly string[];
}

/** How items find their frames. */
export type FrameMatching = 'name' | 'order';

export interface ProposedItem {
  /** As the person knows it: file, page, annotation. */
  readonly label: string;
  /** Name of the image it was drawn on, as far as the file tells; empty where that has none. */
  readonly image: string;
  /** Place among the images of its subject, from 0. */
  readonly order: number;
  /** How many images its subject has, those without an outline too; null where the file does not tell. */
  readonly images: number | null;
  /** SHA-256 of the image's file and the frame in it, where our own format tells. */
  readonly frameId: string | null;
  readonly subject: string;
  /** Of the image it was drawn on, px; null where the file does not tell. */
  readonly size: { readonly width: number; readonly height: number } | null;
  readonly outline: Outline;
  /** Of a mask: with every corner of its pixels. */
  readonly exactOutline: Outline | null;
  /** What was done on the way from a mask: specks, holes. */
  readonly notes: readonly string[];
}

/** What a file of outlines holds, and sentences about what of it is not read. */
export interface ReadOutlines {
  readonly items: readonly ProposedItem[];
  readonly remarks: readonly string[];
}

export function isOfMask({ exactOutline }: ProposedItem): boolean {
  return exactOutline !== null;
}

/** Where an item goes, or why it goes nowhere. */
export type Destination =
  | { readonly kind: 'to'; readonly frame: FrameEntry; readonly number: number; readonly component: ComponentName; readonly replaces: boolean }
  | { readonly kind: 'nowhere'; readonly reason: string };

export interface Assignment {
  readonly item: ProposedItem;
  readonly destination: Destination;
}

/** Which frame and component each item is for. Two items for one cell: the first has it. */
export function assignments(doc: Doc, { items, subjects, match }: Proposal): readonly Assignment[] {
  const taken = new Set<string>();
  return items.map((item) => {
    const destination = destinationOf(doc, item, subjects[item.subject] ?? null, match);
    if (destination.kind === 'nowhere') return { item, destination };
    const key = `${destination.frame.id}/${destination.component}`;
    if (taken.has(key)) {
      const reason = `frame ${destination.number} has an outline of the ${destination.component} from this import already`;
      return { item, destination: { kind: 'nowhere', reason } };
    }
    taken.add(key);
    return { item, destination };
  });
}

function destinationOf(doc: Doc, item: ProposedItem, component: ComponentName | null, match: FrameMatching): Destination {
  if (!component) return nowhere(`"${item.subject}" is left out`);
  const index = frameOf(doc, item, match);
  const frame = doc.frames[index];
  if (!frame) return nowhere(match === 'name' ? `no frame is called ${item.image}` : `there is no frame ${item.order + 1}`);
  const { size } = item;
  if (size && (size.width !== frame.width || size.height !== frame.height)) {
    return nowhere(`its image has ${size.width} x ${size.height} px, frame ${index + 1} has ${frame.width} x ${frame.height}`);
  }
  const replaces = cellOf(doc, frame.id, component).outline !== null;
  return { kind: 'to', frame, number: index + 1, component, replaces };
}

function nowhere(reason: string): Destination {
  return { kind: 'nowhere', reason };
}

/** -1 where there is none. */
function frameOf(doc: Doc, item: ProposedItem, match: FrameMatching): number {
  if (match === 'order') return item.order < doc.frames.length ? item.order : -1;
  const known = item.frameId === null ? -1 : doc.frames.findIndex((frame) => frame.id === item.frameId);
  return known >= 0 ? known : frameNamed(doc, item.image);
}

/** The same name, else the same name but for its ending, else the only one with the same last number. */
export function frameNamed(doc: Doc, image: string): number {
  const exact = doc.frames.findIndex(({ name }) => name === image);
  if (exact >= 0) return exact;
  const wanted = stemOf(image);
  const alike = doc.frames.findIndex(({ name }) => stemOf(name) === wanted);
  if (alike >= 0) return alike;
  const number = lastNumber(wanted);
  if (number === null) return -1;
  const numbered = doc.frames.flatMap(({ name }, index) => (lastNumber(stemOf(name)) === number ? [index] : []));
  return numbered.length === 1 ? numbered[0]! : -1;
}

/** Without folders and ending, small letters; "film.tif #3" keeps its page. */
function stemOf(name: string): string {
  const base = name.split(/[\\/]/).at(-1) ?? name;
  return base.replace(/\.[a-z0-9]+(?=$| #)/i, '').toLowerCase();
}

function lastNumber(stem: string): number | null {
  const digits = /(\d+)(?!.*\d)/.exec(stem)?.[1];
  return digits === undefined ? null : Number(digits);
}

/** By order where no image has a name, or none the name of a frame and there are as many of one as of the other; else by name. */
export function likelyMatch(doc: Doc, items: readonly ProposedItem[]): FrameMatching {
  if (items.every(({ image }) => image === '')) return 'order';
  if (items.some((item) => frameOf(doc, item, 'name') >= 0)) return 'name';
  const most = Math.max(0, ...items.map(({ order, images }) => images ?? order + 1));
  return most === doc.frames.length ? 'order' : 'name';
}

/** Subjects of another number of images than there are frames: by order one that is missing puts all behind it at the frame before. */
export function unevenSubjects(doc: Doc, { items, subjects, match }: Proposal): readonly { readonly subject: string; readonly images: number }[] {
  if (match !== 'order') return [];
  const counts = new Map(items.flatMap(({ subject, images }) => (images !== null && subjects[subject] ? [[subject, images]] : [])));
  return [...counts].flatMap(([subject, images]) => (images === doc.frames.length ? [] : [{ subject, images }]));
}

/** What a subject's name says; null where it says nothing. */
export function componentNamed(subject: string): ComponentName | null {
  const femur = /fem/i.test(subject);
  const tibia = /tib|tray/i.test(subject);
  if (femur === tibia) return null;
  return femur ? 'femur' : 'tibia';
}
