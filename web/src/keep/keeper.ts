import { SESSION_VERSION, plainCell, plainDoc } from '../document/session/session';
import type { Keeping, Store } from '../document/store';
import { Cells } from '../document/cells';
import { cellKey, EMPTY_DOC, type Doc } from '../document/types';
import { texts } from '../texts/texts';
import { PROGRAM } from '../terms/program';
import { filesOf } from '../document/named_files';
import { sentenceOf, type Services } from '../jobs/services';
import { Claims } from './claims';
import { Shelf, type CellChange, type KeptWork } from './shelf';

/** A change waits this long for others to be written with it, ms: what a crash may cost. */
export const WAIT = 400;

/** What a work was like when it was last written. */
interface Written {
  readonly doc: Doc;
  readonly view: string;
}

/**
 * Keeps the work in the browser's own storage while it is done: after each change the cells that differ, and the bytes
 * of each opened file once. A work has one tab that writes it; what the tab leaves for other work is put aside, not
 * lost.
 */
export class Keeper {
  readonly #services: Pick<Services, 'store' | 'assets'>;
  readonly #claims: Claims;
  readonly #open: () => Promise<Shelf>;
  #shelf: Promise<Shelf> | null = null;
  readonly #written = new Map<string, Written>();
  readonly #filesHere = new Set<string>();
  #current = '';
  #timer: ReturnType<typeof setTimeout> | undefined;
  #saving: Promise<void> | null = null;

  constructor(services: Pick<Services, 'store' | 'assets'>, claims = new Claims(), open?: () => Promise<Shelf>) {
    this.#services = services;
    this.#claims = claims;
    this.#open = open ?? (() => Shelf.open(() => (this.#shelf = null)));
    services.store.subscribe(() => this.#notice());
  }

  get #store(): Store {
    return this.#services.store;
  }

  /** The storage, opened when it is first needed and again after the browser took it away. */
  shelf(): Promise<Shelf> {
    this.#shelf ??= this.#open().catch((error: unknown) => {
      this.#shelf = null;
      throw error;
    });
    return this.#shelf;
  }

  /** True if this tab has the work now. */
  claim(id: string): Promise<boolean> {
    return this.#claims.claim(id);
  }

  /** Deletes a work that is open nowhere, and the files that nothing else names. */
  async discard(id: string): Promise<void> {
    if (!(await this.#claims.claim(id))) throw new Error(texts.keep.elsewhere);
    const shelf = await this.shelf();
    await shelf.delete(id);
    this.#written.delete(id);
    await shelf.sweep();
    // What was swept away is written again when it is next needed.
    this.#filesHere.clear();
  }

  /** A document that was just read from the storage is written there already. */
  adopt(doc: Doc): void {
    this.#written.set(doc.work, { doc, view: this.#view() });
    this.#current = doc.work;
    for (const { sha256 } of filesOf(doc)) this.#filesHere.add(sha256);
    const at = Date.now();
    this.#show({ state: 'kept', at });
  }

  /** Writes at once what waits; for the moment before the page goes. */
  flush(): void {
    clearTimeout(this.#timer);
    this.#timer = undefined;
    if (this.#isPending()) void this.#save();
  }

  // --- Noticing -------------------------------------------------------------------------------------------------

  #notice(): void {
    const { doc } = this.#store;
    if (doc.work === '' && hasSomething(doc)) return this.#name();
    if (doc.work !== this.#current) this.#turnTo(doc.work);
    if (this.#isPending()) this.#schedule();
  }

  /** The first thing is there: the work gets an identity. Tells the listeners, and so comes back here. */
  #name(): void {
    const work = crypto.randomUUID();
    this.#store.amend((doc) => (doc.work === '' && hasSomething(doc) ? { ...doc, work } : doc));
  }

  /** Other work is on view: what was there before is not what the next page begins with. */
  #turnTo(work: string): void {
    const before = this.#current;
    this.#current = work;
    if (this.#written.has(before)) {
      this.shelf().then((shelf) => shelf.putAside(before, true)).catch((error: unknown) => this.#refuse(error));
    }
    if (work === '') this.#show({ state: 'nothing' });
    // What comes back by undo is written anew, no longer put aside.
    else if (this.#written.has(work)) this.#written.set(work, { doc: this.#written.get(work)!.doc, view: '' });
  }

  #isPending(): boolean {
    const { doc } = this.#store;
    if (doc.work === '') return false;
    const written = this.#written.get(doc.work);
    return written?.doc !== doc || written.view !== this.#view();
  }

  #schedule(): void {
    const { keeping } = this.#store.ui;
    // Where the person looks is kept too, but it is no work: nobody has to be told that it waits.
    const isWork = this.#written.get(this.#store.doc.work)?.doc !== this.#store.doc;
    if (isWork && keeping.state !== 'pending' && keeping.state !== 'refused') this.#show({ state: 'pending', since: Date.now() });
    if (this.#timer === undefined && !this.#saving) this.#timer = setTimeout(() => this.flush(), WAIT);
  }

  #view(): string {
    const { frameIndex, component, overlayOpacity } = this.#store.ui;
    return JSON.stringify({ frameIndex, component, overlayOpacity });
  }

  // --- Writing --------------------------------------------------------------------------------------------------

  async #save(): Promise<void> {
    if (this.#saving) return this.#saving;
    this.#saving = this.#write();
    await this.#saving;
    this.#saving = null;
    if (this.#isPending()) this.#schedule();
  }

  async #write(): Promise<void> {
    const { doc, ui } = this.#store;
    const view = this.#view();
    try {
      if (!(await this.#claims.claim(doc.work))) throw new Error(texts.keep.elsewhere);
      const shelf = await this.shelf();
      const written = this.#written.get(doc.work);
      await shelf.write(this.#record(doc), changedCells(written?.doc ?? EMPTY_DOC, doc));
      await this.#addFiles(shelf, doc);
      this.#written.set(doc.work, { doc, view });
      if (this.#store.doc.work === doc.work) this.#show({ state: 'kept', at: Date.now() });
      if (ui.keeping.state === 'refused') this.#store.say('info', texts.keep.again);
    } catch (error) {
      this.#refuse(error);
      // Not at once: what is full stays full for a while.
      this.#timer = setTimeout(() => this.flush(), RETRY);
    }
  }

  #record(doc: Doc): KeptWork {
    const { cells: _, ...document } = plainDoc({ ...doc, cells: Cells.NONE });
    return {
      id: doc.work,
      name: doc.name,
      frames: doc.frames.length,
      savedAt: Date.now(),
      putAside: false,
      program: PROGRAM,
      version: SESSION_VERSION,
      document,
      view: JSON.parse(this.#view()) as KeptWork['view'],
      files: filesOf(doc),
    };
  }

  /** Their bytes, once: a file never changes, it is named by what is in it. */
  async #addFiles(shelf: Shelf, doc: Doc): Promise<void> {
    for (const { sha256, name } of filesOf(doc)) {
      if (this.#filesHere.has(sha256)) continue;
      const asset = this.#services.assets.get(sha256);
      // A session may name files that nobody has opened yet.
      if (!asset) continue;
      if (!(await shelf.hasFile(sha256))) await shelf.addFile({ sha256, name, blob: asset.blob });
      this.#filesHere.add(sha256);
    }
  }

  #refuse(error: unknown): void {
    const sentence = refusal(error);
    const { keeping } = this.#store.ui;
    this.#show({ state: 'refused', sentence });
    if (keeping.state !== 'refused' || keeping.sentence !== sentence) this.#store.say('error', sentence);
  }

  #show(keeping: Keeping): void {
    this.#store.show({ keeping });
  }
}

/** After a refusal, ms. */
const RETRY = 5000;

/** A document worth keeping: somebody opened or typed something. */
function hasSomething(doc: Doc): boolean {
  const { work: _work, ...now } = doc;
  const { work: _empty, ...empty } = EMPTY_DOC;
  return (Object.keys(empty) as (keyof typeof empty)[]).some((key) => now[key] !== empty[key]);
}

/** Cells that differ from what was written; cells that are gone as null. */
export function changedCells(before: Doc, after: Doc): CellChange[] {
  return before.cells.differences(after.cells).map(({ frameId, component, after: cell }) => ({ key: cellKey(frameId, component), cell: cell && plainCell(cell) }));
}

/** What the browser's refusal means for the person. */
function refusal(error: unknown): string {
  const name = error instanceof DOMException ? error.name : '';
  if (name === 'QuotaExceededError') return texts.keep.full;
  return texts.keep.refused(sentenceOf(error));
}
