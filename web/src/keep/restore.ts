import { readDoc, readView, SESSION_VERSION } from '../document/session/session';
import { ReadError } from '../document/reader';
import { EMPTY_DOC, type Doc } from '../document/types';
import { TOOL_NAMES } from '../terms/tool';
import { texts } from '../texts/texts';
import { bringFiles } from '../exchange/bring_files';
import { sentenceOf, type Services } from '../jobs/services';
import type { Keeper } from './keeper';
import type { KeptWork, Shelf } from './shelf';
import { work } from '../workers/activity';

/** A document nobody began: undo goes back to what was before. */
const START_ANEW = { label: texts.keep.startAnewLabel, apply: () => EMPTY_DOC };

export function startAnew({ store }: Services): void {
  store.perform(START_ANEW);
  store.show({ viewport: null, popover: null, savedAt: null, selectedPoint: null });
  store.goTo(0);
  store.say('info', texts.keep.startedAnew);
}

/** The work that this tab goes on with: the latest that no other tab has open. Null where there is none. */
export async function workToRestore(keeper: Keeper): Promise<KeptWork | null> {
  const shelf = await keeper.shelf();
  for (const work of await shelf.works()) {
    if (!work.putAside && (await keeper.claim(work.id))) return work;
  }
  return null;
}

/** Brings a work back as the page's beginning: undo ends there. */
export async function restoreWork(services: Services, keeper: Keeper, work: KeptWork): Promise<void> {
  const { store } = services;
  try {
    const doc = await docOf(keeper, work);
    keeper.adopt(doc, work.savedAt);
    store.amend(() => doc);
    store.settle();
    showView(services, work);
    const offer = { label: texts.keep.startAnew, take: () => startAnew(services) };
    store.say('info', texts.keep.restored(work.name, work.savedAt), offer);
    await bringKeptFiles(services, keeper, work, doc);
  } catch (error) {
    store.say('error', texts.keep.notRestored(work.name, sentenceOf(error)));
  }
}

/** Opens work that was put aside. A command: undo brings back what was open. */
export async function openKept(services: Services, keeper: Keeper, id: string): Promise<void> {
  const { store } = services;
  const work = await (await keeper.shelf()).work(id);
  if (!work) throw new Error(texts.keep.gone);
  if (!(await keeper.claim(id))) throw new Error(texts.keep.elsewhere);
  const doc = await docOf(keeper, work);
  store.perform({ label: texts.keep.openLabel, apply: () => doc });
  showView(services, work);
  store.show({ popover: null });
  await bringKeptFiles(services, keeper, work, doc);
  store.say('info', texts.keep.opened(work.name));
}

async function docOf(keeper: Keeper, work: KeptWork): Promise<Doc> {
  if (work.version > SESSION_VERSION) throw new ReadError(texts.keep.newer(work.program));
  const cells = await (await keeper.shelf()).cells(work.id);
  return { ...readDoc({ ...work.document, cells }, texts.keep.place), work: work.id };
}

function showView({ store }: Services, work: KeptWork): void {
  const { frameIndex, component, overlayOpacity } = readView(work.view, texts.keep.place);
  // Sessions have none, nor works from before.
  const { tool: kept } = work.view as { readonly tool?: unknown };
  const tool = TOOL_NAMES.find((name) => name === kept) ?? store.ui.tool;
  store.show({ tool, component, overlayOpacity: Math.min(1, Math.max(0, overlayOpacity)), viewport: null, selectedPoint: null, savedAt: null });
  store.goTo(frameIndex);
}

/** Files are looked at when they are read; models are at once, frames when they are shown. */
async function bringKeptFiles(services: Services, keeper: Keeper, kept: KeptWork, doc: Doc): Promise<void> {
  const over = work.begin();
  try {
    await bringFrom(await keeper.shelf(), services, kept, doc);
  } finally {
    over();
  }
}

async function bringFrom(shelf: Shelf, services: Services, work: KeptWork, doc: Doc): Promise<void> {
  for (const kept of await shelf.files(work.files.map(({ sha256 }) => sha256))) services.assets.keep(kept);
  const missing = await bringFiles(services, doc);
  if (missing.length > 0) services.store.say('error', texts.keep.missing(texts.listed(missing), missing.length));
}
