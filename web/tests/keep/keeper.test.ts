import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Assets } from '../../src/document/assets';
import { addFrames, addPoint, closeOutline, deleteOutline } from '../../src/document/commands';
import type { Place } from '../../src/document/command';
import { Store } from '../../src/document/store';
import { type Doc, EMPTY_DOC } from '../../src/document/types';
import type { Services } from '../../src/jobs/services';
import { Claims } from '../../src/keep/claims';
import { changedCells, Keeper, WAIT } from '../../src/keep/keeper';
import { openKept } from '../../src/keep/restore';
import type { CellChange, KeptWork, Shelf } from '../../src/keep/shelf';
import { framePoint } from '../../src/geometry/points';
import { ClearedBlob } from '../cleared_blob';
import { collectGarbage } from '../garbage';

const PLACE: Place = { frameId: 'f', component: 'femur' };
const SETTLE = 10;

/** A shelf in memory; `refuse` makes it throw, as a full disk would. */
function memory() {
  const works = new Map<string, KeptWork>();
  const cells = new Map<string, Map<string, unknown>>();
  const files = new Set<string>();
  const writes: { work: KeptWork; changes: readonly CellChange[] }[] = [];
  /** `added` is called when a file has been added. */
  const trouble: { refuse: Error | null; only?: string; added?: () => void } = { refuse: null };
  const put = (work: KeptWork, changes: readonly CellChange[], anew: boolean) => {
    if (trouble.refuse && (trouble.only ?? work.name) === work.name) throw trouble.refuse;
    const before = works.get(work.id)?.savedAt ?? null;
    writes.push({ work, changes });
    works.set(work.id, work);
    const of = (!anew && cells.get(work.id)) || new Map<string, unknown>();
    for (const { key, cell } of changes) cell === null ? of.delete(key) : of.set(key, cell);
    cells.set(work.id, of);
    return before;
  };
  const shelf = {
    write: async (work: KeptWork, changes: readonly CellChange[]) => put(work, changes, false),
    writeWhole: async (work: KeptWork, changes: readonly CellChange[]) => void put(work, changes, true),
    putAside: async (id: string) => {
      const work = works.get(id);
      if (work) works.set(id, { ...work, putAside: true });
      return work !== undefined;
    },
    work: async (id: string) => works.get(id) ?? null,
    cells: async (id: string) => Object.fromEntries(cells.get(id) ?? []),
    files: async () => [],
    fileDigests: async () => [...files],
    addFile: async ({ sha256, blob }: { sha256: string; blob: Blob }) => {
      if (blob instanceof ClearedBlob) throw new DOMException('Failed to write blobs', 'DataError');
      files.add(sha256);
      trouble.added?.();
    },
  };
  /** As a browser does whose disk is full. */
  const evict = () => [works, cells, files].forEach((store) => store.clear());
  return { shelf: shelf as unknown as Shelf, evict, works, cells, files, writes, trouble };
}

/** Locks of a browser with as many tabs as ask. */
function locks(): LockManager {
  const held = new Set<string>();
  const request = async (name: string, _options: unknown, callback: (lock: unknown) => unknown) => {
    if (held.has(name)) return callback(null);
    held.add(name);
    return callback({ name });
  };
  return { request } as unknown as LockManager;
}

async function bench(manager = locks()) {
  const store = new Store();
  const assets = new Assets();
  const kept = memory();
  /** Thrown by turns where the storage is opened. */
  const closed: Error[] = [];
  const keeper = new Keeper({ store, assets }, new Claims(manager), async () => {
    const error = closed.shift();
    if (error) throw error;
    return kept.shelf;
  });
  const { sha256 } = await assets.add('f.png', new Blob([Uint8Array.of(1, 2, 3)]));
  const open = () => store.perform(addFrames([{ id: 'f', name: 'f.png', source: sha256, indexInSource: 0, width: 9, height: 9 }]));
  return { store, assets, keeper, open, closed, sha256, ...kept };
}

const point = (column: number) => addPoint(PLACE, framePoint(column, 1));
const passes = (milliseconds: number) => vi.advanceTimersByTimeAsync(milliseconds);

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

describe('keeper', () => {
  it('writes nothing while there is nothing', async () => {
    const { store, writes } = await bench();
    store.show({ tool: 'edit' });
    await passes(10 * WAIT);
    expect(writes).toEqual([]);
    expect(store.ui.keeping).toEqual({ state: 'nothing' });
  });

  it('writes work and files soon after a change, and then only the cells that differ', async () => {
    const { store, open, writes, files, sha256 } = await bench();
    open();
    expect(store.ui.keeping.state).toBe('pending');
    await passes(WAIT + SETTLE);
    expect(store.ui.keeping.state).toBe('kept');
    expect(files).toEqual(new Set([sha256]));
    expect(writes).toHaveLength(1);
    expect(writes[0]!.work).toMatchObject({ frames: 1, putAside: false, files: [{ sha256, name: 'f.png' }] });
    for (const column of [1, 2, 3]) store.perform(point(column));
    await passes(WAIT + SETTLE);
    expect(writes).toHaveLength(2);
    expect(writes[1]!.changes.map(({ key }) => key)).toEqual(['f/femur']);
    expect(writes[1]!.changes[0]!.cell).toMatchObject({ outline: { closed: false, points: [[1, 1], [2, 1], [3, 1]] } });
    await passes(10 * WAIT);
    expect(writes).toHaveLength(2);
  });

  it('goes on writing while somebody never rests', async () => {
    const { store, open, writes } = await bench();
    open();
    for (let step = 0; step < 40; step++) {
      store.preview(point(step));
      await passes(WAIT / 4);
    }
    expect(writes.length).toBeGreaterThan(5);
  });

  it('what comes while it writes is written after it', async () => {
    const { store, open, writes, cells } = await bench();
    open();
    await passes(WAIT + SETTLE);
    store.perform(point(1));
    await passes(WAIT - 1);
    store.perform(point(2));
    await passes(1);
    store.perform(point(3));
    await passes(WAIT + SETTLE);
    expect(writes.length).toBeLessThanOrEqual(3);
    expect(cells.get(store.doc.work)?.get('f/femur')).toMatchObject({ outline: { points: [[1, 1], [2, 1], [3, 1]] } });
  });

  it('flushes at once', async () => {
    const { store, keeper, open, writes } = await bench();
    open();
    store.perform(point(1));
    keeper.flush();
    await passes(0);
    expect(writes).toHaveLength(1);
    expect(store.ui.keeping.state).toBe('kept');
  });

  it('says once that the storage is full, tries again, and says when it is kept again', async () => {
    const { store, open, writes, trouble } = await bench();
    trouble.refuse = new DOMException('no room', 'QuotaExceededError');
    open();
    await passes(WAIT + SETTLE);
    expect(store.ui.keeping.state).toBe('refused');
    expect(store.ui.notice?.text).toMatch(/no room left/);
    const said = store.ui.log.length;
    store.perform(point(1));
    await passes(5 * WAIT);
    expect(store.ui.log.length).toBe(said);
    trouble.refuse = null;
    await passes(10_000);
    expect(writes).toHaveLength(1);
    expect(store.ui.keeping.state).toBe('kept');
    expect(store.ui.notice?.text).toMatch(/again/);
  });

  it('puts aside what is left for other work, and takes it up again by undo', async () => {
    const { store, open, works } = await bench();
    open();
    await passes(WAIT + SETTLE);
    const first = store.doc.work;
    store.perform({ label: 'start anew', apply: () => EMPTY_DOC });
    await passes(WAIT + SETTLE);
    expect(works.get(first)?.putAside).toBe(true);
    expect(store.ui.keeping.state).toBe('nothing');
    store.undo();
    await passes(WAIT + SETTLE);
    expect(store.doc.work).toBe(first);
    expect(works.get(first)?.putAside).toBe(false);
    expect(works.size).toBe(1);
  });

  it('holds no work that was left and is written', async () => {
    const { store, open, works } = await bench();
    const left: WeakRef<Doc>[] = [];
    for (let work = 0; work < 5; work++) {
      open();
      // Of some the last is not written yet when they are left.
      if (work % 2 === 0) await passes(WAIT + SETTLE);
      store.perform(point(work));
      if (work === 4) await passes(WAIT + SETTLE);
      left.push(new WeakRef(store.doc));
      store.perform(START_ANEW);
      await passes(WAIT + SETTLE);
    }
    expect(works.size).toBe(5);
    // Undo would lead to them.
    store.settle();
    vi.useRealTimers();
    await new Promise((resolve) => setTimeout(resolve));
    collectGarbage();
    expect(left.filter((doc) => doc.deref())).toHaveLength(0);
  });

  it('does not write what another tab has', async () => {
    const manager = locks();
    const one = await bench(manager);
    const other = await bench(manager);
    one.open();
    await passes(WAIT + SETTLE);
    other.store.amend(() => one.store.doc);
    await passes(WAIT + SETTLE);
    expect(other.writes).toEqual([]);
    expect(other.store.ui.keeping).toMatchObject({ state: 'refused' });
    expect(other.store.ui.notice?.text).toMatch(/open in another tab/);
  });

  const START_ANEW = { label: 'start anew', apply: () => EMPTY_DOC };
  const named = (name: string) => ({ label: 'name', apply: (doc: typeof EMPTY_DOC) => ({ ...doc, name }) });

  it('writes all of it again where the browser says that it took the storage away', async () => {
    const { store, keeper, open, works, cells, files, evict, sha256 } = await bench();
    open();
    store.perform(point(1));
    await passes(WAIT + SETTLE);
    evict();
    keeper.lost();
    expect(store.ui.keeping.state).toBe('pending');
    await passes(WAIT + SETTLE);
    expect(store.ui.keeping.state).toBe('kept');
    expect(cells.get(store.doc.work)?.get('f/femur')).toMatchObject({ outline: { points: [[1, 1]] } });
    expect([...works.keys()]).toEqual([store.doc.work]);
    expect(files).toEqual(new Set([sha256]));
  });

  it('writes all of it again where it is gone without a word', async () => {
    const { store, open, cells, files, evict, sha256 } = await bench();
    open();
    store.perform(point(1));
    await passes(WAIT + SETTLE);
    evict();
    store.perform(named('goes on'));
    await passes(WAIT + SETTLE);
    expect(store.ui.keeping.state).toBe('kept');
    expect(cells.get(store.doc.work)?.get('f/femur')).toMatchObject({ outline: { points: [[1, 1]] } });
    expect(files).toEqual(new Set([sha256]));
  });

  it('says that nothing waits only when all is there again, where the storage is taken away in the middle of writing', async () => {
    const { store, keeper, open, works, files, evict, trouble, sha256 } = await bench();
    let evictions = 0;
    trouble.added = () => {
      if (++evictions > 2) return;
      evict();
      keeper.lost();
    };
    const seen: unknown[] = [];
    store.subscribe(() => store.ui.keeping.state === 'kept' && seen.push([works.size, files.size]));
    open();
    await passes(5 * WAIT);
    expect(store.ui.keeping.state).toBe('kept');
    expect([...works.keys()]).toEqual([store.doc.work]);
    expect(files).toEqual(new Set([sha256]));
    expect(seen.every((there) => String(there) === '1,1')).toBe(true);
  });

  it('opens the storage again soon where the browser was still clearing it, and tells nobody', async () => {
    const { store, open, works, files, closed, sha256 } = await bench();
    closed.push(...Array.from({ length: 3 }, () => new DOMException('The connection was closed.', 'AbortError')));
    const said = store.ui.log.length;
    open();
    await passes(4 * WAIT + SETTLE);
    expect(store.ui.keeping.state).toBe('kept');
    expect(store.ui.log.length).toBe(said);
    expect([...works.keys()]).toEqual([store.doc.work]);
    expect(files).toEqual(new Set([sha256]));
  });

  it('says that the storage cannot be opened where that goes on, and goes on trying', async () => {
    const { store, open, works, closed } = await bench();
    closed.push(...Array.from({ length: 6 }, () => new DOMException('The connection was closed.', 'AbortError')));
    open();
    await passes(5 * WAIT);
    expect(store.ui.keeping.state).toBe('refused');
    await passes(20_000);
    expect(store.ui.keeping.state).toBe('kept');
    expect([...works.keys()]).toEqual([store.doc.work]);
  });

  it('opens the storage anew where its connection was closed without a word, and writes all of it again', async () => {
    const { store, open, works, cells, files, evict, trouble, closed, sha256 } = await bench();
    open();
    store.perform(point(1));
    await passes(WAIT + SETTLE);
    evict();
    trouble.refuse = new DOMException('The database connection is closing.', 'InvalidStateError');
    // The one that is opened in its place is open.
    const { shift } = closed;
    closed.shift = () => {
      trouble.refuse = null;
      return shift.call(closed);
    };
    store.perform(named('goes on'));
    await passes(2 * WAIT + SETTLE);
    expect(store.ui.keeping.state).toBe('kept');
    expect(works.get(store.doc.work)?.name).toBe('goes on');
    expect(cells.get(store.doc.work)?.get('f/femur')).toMatchObject({ outline: { points: [[1, 1]] } });
    expect(files).toEqual(new Set([sha256]));
  });

  it('names the files that went with the storage, keeps all else, and takes the originals when they are dropped', async () => {
    const { store, assets, keeper, open, works, files, evict, sha256 } = await bench();
    const bytes = Uint8Array.of(4, 5, 6);
    const other = await assets.add('g.png', new Blob([bytes]));
    open();
    store.perform(addFrames([{ id: 'g', name: 'g.png', source: other.sha256, indexInSource: 0, width: 9, height: 9 }]));
    Object.assign(assets.get(sha256)!, { blob: new ClearedBlob() });
    files.add(sha256);
    await passes(WAIT + SETTLE);
    expect(store.ui.keeping.state).toBe('kept');
    evict();
    keeper.lost();
    await passes(WAIT + SETTLE);
    expect(store.ui.keeping).toMatchObject({ state: 'refused', sentence: expect.stringMatching(/no copy any more of f\.png, .* drop the original on/) });
    expect(store.ui.notice?.text).toMatch(/f\.png/);
    expect([...works.keys()]).toEqual([store.doc.work]);
    expect(files).toEqual(new Set([other.sha256]));
    const said = store.ui.log.length;
    await passes(10_000);
    expect(store.ui.keeping.state).toBe('refused');
    expect(store.ui.log.length).toBe(said);
    await assets.add('f.png', new Blob([Uint8Array.of(1, 2, 3)]));
    await passes(10_000);
    expect(store.ui.keeping.state).toBe('kept');
    expect(files).toEqual(new Set([sha256, other.sha256]));
  });

  it('writes what is left again where it is gone without a word, aside', async () => {
    const { store, open, works, files, evict, sha256 } = await bench();
    open();
    await passes(WAIT + SETTLE);
    evict();
    const { work } = store.doc;
    store.perform(START_ANEW);
    await passes(WAIT + SETTLE);
    expect(works.get(work)).toMatchObject({ putAside: true });
    expect(files).toEqual(new Set([sha256]));
    expect(store.ui.keeping.state).toBe('nothing');
  });

  it('adds a file again that another tab swept away while no work named it', async () => {
    const { store, open, files, sha256 } = await bench();
    open();
    await passes(WAIT + SETTLE);
    store.perform({ label: 'no frames', apply: (doc) => ({ ...doc, frames: [], name: 'without' }) });
    await passes(WAIT + SETTLE);
    files.clear();
    store.undo();
    await passes(WAIT + SETTLE);
    expect(store.ui.keeping.state).toBe('kept');
    expect(files).toEqual(new Set([sha256]));
  });

  it('writes the last of what is left for other work, aside', async () => {
    const { store, open, works, cells } = await bench();
    open();
    await passes(WAIT + SETTLE);
    store.perform(point(1));
    const { work } = store.doc;
    store.perform(START_ANEW);
    expect(store.ui.keeping.state).toBe('pending');
    await passes(WAIT + SETTLE);
    expect(store.ui.keeping.state).toBe('nothing');
    expect(cells.get(work)?.get('f/femur')).toMatchObject({ outline: { points: [[1, 1]] } });
    expect(works.get(work)?.putAside).toBe(true);
  });

  it('what was left and finds no room is said, holds up nothing else, and is written when there is room', async () => {
    const { store, open, works, trouble } = await bench();
    trouble.refuse = new DOMException('no room', 'QuotaExceededError');
    trouble.only = 'large';
    open();
    store.perform(named('large'));
    await passes(WAIT + SETTLE);
    const { work } = store.doc;
    store.perform(START_ANEW);
    expect(store.ui.keeping.state).toBe('refused');
    store.perform(named('small'));
    await passes(10_000);
    expect(works.get(store.doc.work)?.name).toBe('small');
    expect(store.ui.keeping.state).toBe('refused');
    trouble.refuse = null;
    await passes(10_000);
    expect(store.ui.keeping.state).toBe('kept');
    expect(works.get(work)).toMatchObject({ name: 'large', putAside: true });
  });

  it('what was left and found no room is opened again as it was left, not in the state that the storage has', async () => {
    const { store, assets, keeper, open, cells, trouble } = await bench();
    const services = { store, assets, studio: { knowFrame: () => undefined } } as unknown as Services;
    open();
    await passes(WAIT + SETTLE);
    const { work } = store.doc;
    trouble.refuse = new DOMException('full', 'QuotaExceededError');
    for (const column of [1, 2, 3]) store.perform(point(column));
    await passes(WAIT + SETTLE);
    const latest = store.doc;
    store.perform(START_ANEW);
    store.perform(named('another'));
    await openKept(services, keeper, work);
    expect(store.doc).toBe(latest);
    trouble.refuse = null;
    await passes(20_000);
    expect(store.ui.keeping.state).toBe('kept');
    expect(JSON.stringify([...cells.get(work)!.values()])).toContain('[3,1]');
    // Once it is written the storage has all of it.
    store.perform(START_ANEW);
    await passes(WAIT + SETTLE);
    await openKept(services, keeper, work);
    expect(store.doc).not.toBe(latest);
    expect(store.doc.cells.at('f', 'femur')?.outline?.points).toHaveLength(3);
  });

  it('is no unit of undo', async () => {
    const { store, open } = await bench();
    open();
    const units = store.state.history.past.length;
    await passes(WAIT + SETTLE);
    expect(store.state.history.past.length).toBe(units);
    store.undo();
    expect(store.doc.frames).toEqual([]);
  });
});

describe('cells that changed', () => {
  it('are those that came, differ or went', () => {
    const store = new Store();
    store.perform(addFrames([{ id: 'f', name: 'f', source: 's', indexInSource: 0, width: 9, height: 9 }]));
    const docs = [store.doc];
    for (const column of [1, 2, 3]) store.perform(point(column));
    docs.push(store.doc);
    store.perform(closeOutline(PLACE));
    docs.push(store.doc);
    store.perform(deleteOutline(PLACE));
    const keys = (before: number, after: number) => changedCells(docs[before]!, docs[after]!).map(({ key }) => key);
    expect([keys(0, 1), keys(1, 2), keys(2, 2)]).toEqual([['f/femur'], ['f/femur'], []]);
    expect(changedCells(docs[1]!, docs[0]!)).toEqual([{ key: 'f/femur', cell: null }]);
  });
});
