import { SESSION_VERSION, plainCell, plainDoc } from '../document/session/session';
import type { Keeping, Store } from '../document/store';
import { Cells } from '../document/cells';
import { cellKey, EMPTY_DOC, type Doc } from '../document/types';
import { texts } from '../texts/texts';
import { PROGRAM } from '../terms/program';
import { filesOf } from '../document/named_files';
import type { Services } from '../jobs/services';
import { Claims } from './claims';
import { addFiles } from './kept_files';
import { FilesGone, isTakenAway, refusal } from './refusals';
import { Shelf, type CellChange, type KeptWork } from './shelf';

/** A change waits this long for others to be written with it, ms: what a crash may cost. */
export const WAIT = 400;

/** A work and where the person looked in it. */
export interface Seen {
  readonly doc: Doc;
  readonly view: string;
}

/** What a work was like when it was last written. */
interface Written extends Seen {
  /** By this the storage is known to hold that still. */
  readonly savedAt: number;
  /** All files that it names are there. */
  readonly hasFiles: boolean;
  /** Names of those that the storage had, and that the page cannot read any more. */
  readonly gone: readonly string[];
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
  /** Works on view or left; others are let go, and what comes back by undo is written anew, no longer put aside. */
  #written = new Map<string, Written>();
  /** Work that was left for other work before all of it was written. */
  readonly #left = new Map<string, Seen>();
  #latest = EMPTY_DOC;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #saving: Promise<void> | null = null;
  /** How often in a row the storage was taken away while it was written to. */
  #interruptions = 0;

  constructor(services: Pick<Services, 'store' | 'assets'>, claims = new Claims(), open?: () => Promise<Shelf>) {
    this.#services = services;
    this.#claims = claims;
    this.#open = open ?? (() => Shelf.open(() => this.lost()));
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

  /** The browser took the storage away: what was written there may be gone, and is written again. */
  lost(): void {
    this.#shelf = null;
    // What is being written just now is noted in the old one, where nobody looks.
    this.#written = new Map();
    // Not at once: as long as it clears, the browser opens nothing.
    clearTimeout(this.#timer);
    this.#timer = undefined;
    this.#notice();
  }

  /** True if this tab has the work now. */
  claim(id: string): Promise<boolean> {
    return this.#claims.claim(id);
  }

  /** A work as it was left for other work, as long as the storage has not all of it; null once it has. */
  left(id: string): Seen | null {
    return this.#left.get(id) ?? null;
  }

  /** Deletes a work that is open nowhere, and the files that nothing else names. */
  async discard(id: string): Promise<void> {
    if (!(await this.#claims.claim(id))) throw new Error(texts.keep.elsewhere);
    const shelf = await this.shelf();
    await shelf.delete(id);
    this.#written.delete(id);
    this.#left.delete(id);
    await shelf.sweep();
  }

  /** A document that was just read from the storage is written there already. */
  adopt(doc: Doc, savedAt: number): void {
    this.#written.set(doc.work, { doc, view: this.#view(), savedAt, hasFiles: false, gone: [] });
    this.#latest = doc;
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
    const before = this.#latest;
    this.#latest = doc;
    if (doc.work !== before.work) this.#turn(before, doc);
    if (this.#isPending()) this.#schedule();
  }

  /** The first thing is there: the work gets an identity. Tells the listeners, and so comes back here. */
  #name(): void {
    const work = crypto.randomUUID();
    this.#store.amend((doc) => (doc.work === '' && hasSomething(doc) ? { ...doc, work } : doc));
  }

  /** Other work is on view: what was there before is not what the next page begins with. */
  #turn(before: Doc, { work }: Doc): void {
    if (this.#written.get(before.work)?.doc === before) {
      this.#written.delete(before.work);
      void this.#putAside({ doc: before, view: this.#view() });
    } else if (before.work !== '') this.#left.set(before.work, { doc: before, view: this.#view() });
    this.#left.delete(work);
    if (work === '' && this.#left.size === 0) this.#show({ state: 'nothing' });
  }

  /** Work that is written; where the browser cleared it just now, it is written again. */
  async #putAside(seen: Seen): Promise<void> {
    const { work } = seen.doc;
    try {
      const shelf = await this.shelf();
      if (await shelf.putAside(work)) return;
    } catch (error) {
      if (!isTakenAway(error)) return this.#refuse(error);
    }
    // Undo may have brought it back.
    if (this.#store.doc.work !== work) this.#left.set(work, seen);
    this.lost();
  }

  #isPending(): boolean {
    return this.#left.size > 0 || !this.#isWritten(this.#view());
  }

  /** `view`: where the person looks; without it the work alone counts. */
  #isWritten(view?: string): boolean {
    const { doc } = this.#store;
    const written = this.#written.get(doc.work);
    return doc.work === '' || (written?.doc === doc && written.gone.length === 0 && (view === undefined || written.view === view));
  }

  #schedule(): void {
    const { keeping } = this.#store.ui;
    // Where the person looks is kept too, but it is no work: nobody has to be told that it waits.
    const isWork = this.#left.size > 0 || !this.#isWritten();
    if (isWork && keeping.state !== 'pending' && keeping.state !== 'refused') this.#show({ state: 'pending', since: Date.now() });
    if (this.#timer === undefined && !this.#saving) this.#timer = setTimeout(() => this.flush(), WAIT);
  }

  #view(): string {
    const { frameIndex, component, overlayOpacity, tool } = this.#store.ui;
    return JSON.stringify({ frameIndex, component, overlayOpacity, tool });
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
    try {
      // What is on view comes first: the page may be about to go.
      const gone = doc.work === '' ? [] : await this.#put({ doc, view: this.#view() }, false);
      await this.#writeLeft();
      this.#interruptions = 0;
      if (gone.length > 0 && this.#store.doc.work === doc.work) throw new FilesGone(gone);
      if (ui.keeping.state === 'refused') this.#store.say('info', texts.keep.again);
      this.#tell();
    } catch (error) {
      this.#stop(error);
    }
  }

  async #writeLeft(): Promise<void> {
    for (const [id, left] of [...this.#left]) {
      const gone = await this.#put(left, true);
      if (this.#left.get(id) !== left) continue;
      this.#left.delete(id);
      this.#written.delete(id);
      // Nobody looks at it, and nothing that is on view is less safe for it: it is said once.
      if (gone.length > 0) this.#store.say('error', refusal(new FilesGone(gone)));
    }
  }

  /** Says that nothing waits, if that is so still: there may be news since this was begun. */
  #tell(): void {
    if (this.#left.size > 0 || !this.#isWritten()) {
      if (this.#store.ui.keeping.state === 'refused') this.#show({ state: 'pending', since: Date.now() });
    } else this.#show(this.#store.doc.work === '' ? { state: 'nothing' } : { state: 'kept', at: Date.now() });
  }

  #stop(error: unknown): void {
    if (isTakenAway(error)) {
      this.lost();
      // It is opened anew, and all is written again, before anybody has to be told.
      if (++this.#interruptions <= INTERRUPTIONS) return;
    }
    this.#refuse(error);
    // Not at once: what is full stays full for a while.
    this.#timer = setTimeout(() => this.flush(), RETRY);
  }

  /** Writes a work with its files: of its cells those that changed, where the storage still has the others. Names of files that are gone. */
  async #put(seen: Seen, putAside: boolean): Promise<readonly string[]> {
    const { doc } = seen;
    if (!(await this.#claims.claim(doc.work))) throw new Error(texts.keep.elsewhere);
    const shelf = await this.shelf();
    const known = this.#written;
    const written = known.get(doc.work);
    const record = recordOf(seen, putAside);
    const goesOn = written !== undefined && (await shelf.write(record, changedCells(written.doc, doc))) === written.savedAt;
    if (!goesOn) await shelf.writeWhole(record, changedCells(EMPTY_DOC, doc));
    const namesTheSame = written?.doc.frames === doc.frames && written.doc.components === doc.components;
    const hadFiles = goesOn && namesTheSame && written.hasFiles;
    const { isAll, gone } = hadFiles ? { isAll: true, gone: [] } : await addFiles(shelf, this.#services.assets, filesOf(doc));
    known.set(doc.work, { ...seen, savedAt: record.savedAt, hasFiles: isAll, gone });
    return gone;
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

function recordOf({ doc, view }: Seen, putAside: boolean): KeptWork {
  const { cells: _, ...document } = plainDoc({ ...doc, cells: Cells.NONE });
  return {
    id: doc.work,
    name: doc.name,
    frames: doc.frames.length,
    savedAt: Date.now(),
    putAside,
    program: PROGRAM,
    version: SESSION_VERSION,
    document,
    view: JSON.parse(view) as KeptWork['view'],
    files: filesOf(doc),
  };
}

/** After a refusal, ms. */
const RETRY = 5000;

/** So often in a row the storage may be taken away before that is a refusal. */
const INTERRUPTIONS = 3;

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
