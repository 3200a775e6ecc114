import { itemOfMask, type OutlineKind, readOutlineFiles, TOLERANCE } from './outline_readers';
import { componentNamed, likelyMatch, type ProposedItem } from '../document/proposal';
import type { ComponentName } from '../terms/component';
import { later } from '../texts/later';
import { Aborted } from '../workers/bridge';
import { bytesOf, type Incoming } from './incoming';
import { byName } from './name_order';
import { pathOf } from './paths';
import { lookedAt } from './reading';
import type { Store } from '../document/store';
import { asJob, sentenceOf, type Services } from '../jobs/services';
import { masksWorker } from '../workers/start';
import type { MaskLook, MaskPage } from '../workers/protocol/masks';

/** Files of outlines, as they were recognised. */
export interface OutlineFile extends Incoming {
  readonly kind: 'mask' | OutlineKind;
}

/**
 * Reads outlines and masks and shows which frame and component each would be for; nothing of the document changes
 * before the person says so.
 */
export async function propose(services: Services, files: readonly OutlineFile[], asFrames: (() => void) | null): Promise<void> {
  const { store } = services;
  const items: ProposedItem[] = [];
  const remarks: string[] = [];
  const read = await readOutlineFiles(files.flatMap(({ kind, ...file }) => (kind === 'mask' ? [] : [{ ...file, kind }])));
  items.push(...read.items);
  remarks.push(...read.remarks);
  const masks = files.filter(({ kind }) => kind === 'mask').sort((a, b) => byName(pathOf(a), pathOf(b)));
  items.push(...(await readMasks(services, masks, remarks)));
  if (items.length === 0) {
    for (const remark of remarks) store.say('error', remark);
    if (remarks.length === 0) store.say('error', later.exchange.nothing);
    return;
  }
  const match = likelyMatch(store.doc, items);
  store.show({
    proposal: { items, subjects: subjectsOf(items, store.ui.component), match, exact: false, onFrames: true, asFrames, remarks },
    popover: 'import',
  });
}

/** By name; where there is but one subject and its name says nothing, it is the component that is selected. */
function subjectsOf(items: readonly ProposedItem[], selected: ComponentName): Record<string, ComponentName | null> {
  const subjects = [...new Set(items.map(({ subject }) => subject))];
  const only = subjects.length === 1 ? selected : null;
  const taken = new Set<ComponentName>();
  return Object.fromEntries(
    subjects.map((subject) => {
      const component = componentNamed(subject) ?? only;
      // Of several sources of masks of one component the first is proposed, and a person may choose another.
      const isFree = component !== null && !taken.has(component);
      if (isFree) taken.add(component);
      return [subject, isFree ? component : null];
    }),
  );
}

// --- Masks --------------------------------------------------------------------------------------------------------

async function readMasks(services: Services, files: readonly OutlineFile[], remarks: string[]): Promise<ProposedItem[]> {
  if (files.length === 0) return [];
  const abort = new AbortController();
  const worker = masksWorker();
  const pages: ReadMask[] = [];
  const job = { title: later.exchange.reading, unit: later.exchange.files, total: files.length, cancel: () => abort.abort() };
  try {
    await asJob(services.store, job, async (report) => {
      for (const [index, file] of files.entries()) {
        try {
          const { blob, name } = file;
          const bytes = await bytesOf(blob);
          const found = await worker.call('read', { bytes, name, tolerance: TOLERANCE }, { signal: abort.signal });
          found.forEach((page, at) => pages.push({ file, place: found.length === 1 ? '' : ` #${at + 1}`, page }));
        } catch (error) {
          if (error instanceof Aborted) throw error;
          remarks.push(`${pathOf(file)}: ${sentenceOf(error)}`);
          pages.push({ file, place: '', page: null });
        }
        report(index + 1, files.length);
      }
    });
  } finally {
    worker.dispose();
  }
  return itemsOf(pages, remarks);
}

/** A page of a file of masks; `null` where it could not be read. */
export interface ReadMask {
  readonly file: OutlineFile;
  /** Which of several pages of the file. */
  readonly place: string;
  readonly page: MaskPage | null;
}

/** Exported for its test. A mask that is empty or cannot be read keeps its place: by order those behind it would be one frame too early. */
export function itemsOf(pages: readonly ReadMask[], remarks: string[]): ProposedItem[] {
  const subjectOf = subjectsByFolder(pages.map(({ file }) => pathOf(file)));
  const several = pages.some(({ page }) => (page?.labels.length ?? 0) > 1);
  // Labels of one picture stand at its place, of whatever they are.
  const group = (file: OutlineFile) => (several ? '' : subjectOf(pathOf(file)));
  const counts = new Map<string, number>();
  const placed = pages.map((one) => {
    const order = counts.get(group(one.file)) ?? 0;
    counts.set(group(one.file), order + 1);
    return { ...one, order };
  });
  return placed.flatMap(({ file, place, page, order }) => {
    const path = pathOf(file) + place;
    if (page?.labels.length === 0) remarks.push(later.exchange.emptyMask(path));
    const images = counts.get(group(file)) ?? null;
    return (page?.labels ?? []).map((label) => {
      const subject = several ? later.exchange.value(label.value) : subjectOf(pathOf(file));
      const { width, height } = page!;
      const image = file.name + place;
      return itemOfMask({ label: several ? `${path}, ${subject}` : path, image, order, images, frameId: null, subject, size: { width, height } }, label);
    });
  });
}

/** What masks are of, by their paths: the component, or the folder where one component has masks in several. */
function subjectsByFolder(paths: readonly string[]): (path: string) => string {
  const folderOf = (path: string) => path.split('/').slice(0, -1).slice(-2).join('/');
  const folders = new Map<ComponentName, Set<string>>();
  for (const path of paths) {
    const component = componentNamed(path);
    if (component) folders.set(component, (folders.get(component) ?? new Set()).add(folderOf(path)));
  }
  return (path) => {
    const component = componentNamed(path);
    if (!component) return later.exchange.unnamed;
    const folder = folderOf(path);
    // A folder's name that says nothing of the component would be taken for none.
    const tells = componentNamed(folder) === component && (folders.get(component)?.size ?? 0) > 1;
    return tells ? folder : component;
  };
}

// --- Recognising --------------------------------------------------------------------------------------------------

/** Which of some images are masks. Cheap for frames: what is packed less than a mask would be is not looked at. */
export async function masksAmong<F extends Incoming & { readonly head: Uint8Array<ArrayBuffer> }>(store: Store, files: readonly F[]): Promise<ReadonlySet<F>> {
  const candidates = files.filter(({ head, blob }) => mayBeMask(head, blob.size));
  if (candidates.length === 0) return new Set();
  const worker = masksWorker();
  try {
    // What cannot be decoded is a frame's trouble, and told there.
    const look = async ({ blob, name }: Incoming) => worker.call('look', { bytes: await bytesOf(blob), name }).catch(() => null);
    const looks = await lookedAt(store, candidates, look);
    return masksBy(files, new Map(candidates.map((file, index) => [file, looks[index] ?? null])), store.doc.frames.length > 0);
  } finally {
    worker.dispose();
  }
}

/**
 * By what was seen in files. One without any label is a mask among masks, and a blank frame of the film in a folder that holds frames and no masks
 * besides; graded ones are masks in a folder without frames. A picture among masks, where frames lie elsewhere or are open (`framesAreOpen`), is a
 * mask that went wrong, and is told so where it is read: as a frame it would stand in the film.
 */
export function masksBy<F extends Incoming>(files: readonly F[], looks: ReadonlyMap<F, MaskLook>, framesAreOpen = false): ReadonlySet<F> {
  const folderOf = ({ name, path }: Incoming) => (path ?? name).slice(0, -name.length);
  const lookOf = (file: F) => looks.get(file) ?? null;
  const inFolder = (folder: string, is: (look: MaskLook) => boolean) => files.filter((file) => folderOf(file) === folder && is(lookOf(file))).length;
  const folders = [...new Set(files.map(folderOf))];
  const ofFrames = new Set(folders.filter((folder) => inFolder(folder, isPicture) > 0));
  const ofMasks = new Set(folders.filter((folder) => inFolder(folder, hasLabels) > 0));
  const ofMasksAlone = [...ofMasks].filter((folder) => inFolder(folder, hasLabels) >= MASKS_A_PICTURE * inFolder(folder, isPicture));
  const framesAreElsewhere = framesAreOpen || [...ofFrames].some((folder) => !ofMasksAlone.includes(folder));
  const isMask = (file: F) => {
    const [look, folder] = [lookOf(file), folderOf(file)];
    if (look === null) return framesAreElsewhere && ofMasksAlone.includes(folder);
    if (look === 'graded') return !ofFrames.has(folder);
    return look === 0 ? !ofFrames.has(folder) || ofMasks.has(folder) : true;
  };
  return new Set(files.filter(isMask));
}

/** Frames may lie in one folder with their masks, a few of each frame: so many of one are not of it. */
const MASKS_A_PICTURE = 5;

const isPicture = (look: MaskLook) => look === null;
const hasLabels = (look: MaskLook) => typeof look === 'number' && look > 0;

/** So many bytes of a PNG tell its size. */
const HEAD = 33;

/** By the beginning of a file and its length: a PNG of fewer bits a pixel than an X-ray ever packs to, or any TIFF or NumPy array. */
export function mayBeMask(head: Uint8Array<ArrayBuffer>, length: number): boolean {
  const view = new DataView(head.buffer, head.byteOffset, head.byteLength);
  if (length < HEAD) return false;
  const first = view.getUint32(0);
  if (first === 0x49492a00 || first === 0x4d4d002a || first === 0x934e554d) return true;
  if (first !== 0x89504e47) return false;
  const pixels = view.getUint32(16) * view.getUint32(20);
  return length < MASK_OVERHEAD + pixels * MASK_BYTES;
}

/** Headers of a small PNG, and bytes a pixel of a large one. */
const MASK_OVERHEAD = 200;
const MASK_BYTES = 0.1;
