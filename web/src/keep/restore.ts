import { readDoc, readView, SESSION_VERSION } from '../document/session/session';
import { ReadError } from '../document/reader';
import { startEmpty } from '../document/start_anew';
import type { Doc } from '../document/types';
import { TOOL_NAMES } from '../terms/tool';
import { texts } from '../texts/texts';
import { bringFiles } from '../exchange/bring_files';
import { sentenceOf, type Services } from '../jobs/services';
import type { Keeper } from './keeper';
import type { KeptWork } from './shelf';
import { work } from '../workers/activity';

export function startAnew({ store }: Services): void {
  startEmpty(store);
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
    const doc = await counted(readWhole(services, keeper, work));
    keeper.adopt(doc, work.savedAt);
    store.amend(() => doc);
    store.settle();
    showView(services, work.view);
    const offer = { label: texts.keep.startAnew, take: () => startAnew(services) };
    store.say('info', texts.keep.restored(work.name, work.savedAt), offer);
    await bringKeptFiles(services, doc);
  } catch (error) {
    const words = (await isStillKept(keeper, work)) ? texts.keep.notRestored(work.name, sentenceOf(error)) : texts.keep.cleared(work.name);
    store.say('error', words);
  }
}

/** Unknown is yes: nobody is told of a loss that may be none. */
function isStillKept(keeper: Pick<Keeper, 'shelf'>, { id }: KeptWork): Promise<boolean> {
  return keeper.shelf().then((shelf) => shelf.work(id)).then((found) => found !== null, () => true);
}

/** Opens work that was put aside, as it was left. A command: undo brings back what was open. */
export async function openKept(services: Services, keeper: Keeper, id: string): Promise<void> {
  const { store } = services;
  // What the storage has no room for is here alone.
  const left = keeper.left(id);
  const { doc, view } = left ? { doc: left.doc, view: JSON.parse(left.view) as KeptWork['view'] } : await readKept(services, keeper, id);
  store.perform({ label: texts.keep.openLabel, apply: () => doc });
  showView(services, view);
  store.show({ popover: null });
  await bringKeptFiles(services, doc);
  store.say('info', texts.keep.opened(doc.name));
}

/** What the storage has of a work that no other tab has open. */
async function readKept(services: Services, keeper: Keeper, id: string): Promise<{ readonly doc: Doc; readonly view: KeptWork['view'] }> {
  const work = await (await keeper.shelf()).work(id);
  if (!work) throw new Error(texts.keep.gone);
  if (!(await keeper.claim(id))) throw new Error(texts.keep.elsewhere);
  return { doc: await counted(readWhole(services, keeper, work)), view: work.view };
}

/**
 * The document, with its files at hand: what the browser clears from then on is still in the page, or missed by the keeper. Half a work, of
 * which the rest was cleared while it was read, is none.
 */
async function readWhole({ assets }: Services, keeper: Keeper, work: KeptWork): Promise<Doc> {
  if (work.version > SESSION_VERSION) throw new ReadError(texts.keep.newer(work.program));
  const shelf = await keeper.shelf();
  const cells = await shelf.cells(work.id);
  const files = await shelf.files(work.files.map(({ sha256 }) => sha256));
  if ((await shelf.work(work.id)) === null) throw new Error(texts.keep.gone);
  for (const kept of files) assets.keep(kept);
  return { ...readDoc({ ...work.document, cells }, texts.keep.place), work: work.id };
}

function showView({ store }: Services, view: KeptWork['view']): void {
  const { frameIndex, component, overlayOpacity } = readView(view, texts.keep.place);
  // Sessions have none, nor works from before.
  const { tool: kept } = view as { readonly tool?: unknown };
  const tool = TOOL_NAMES.find((name) => name === kept) ?? store.ui.tool;
  store.show({ tool, component, overlayOpacity: Math.min(1, Math.max(0, overlayOpacity)), viewport: null, selectedPoint: null, savedAt: null });
  store.goTo(frameIndex);
}

/** Files are looked at when they are read; models are at once, frames when they are shown. */
async function bringKeptFiles(services: Services, doc: Doc): Promise<void> {
  const troubles: string[] = [];
  const missing = await counted(bringFiles(services, doc, troubles));
  if (missing.length > 0) troubles.push(texts.keep.missing(texts.listed(missing), missing.length));
  if (troubles.length > 0) services.store.say('error', troubles.join(' '));
}

/** As work that is under way. */
async function counted<T>(underWay: Promise<T>): Promise<T> {
  const over = work.begin();
  try {
    return await underWay;
  } finally {
    over();
  }
}
