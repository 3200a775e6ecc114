import { beforeEach, describe, expect, it, vi } from 'vitest';
import { addFrames } from '../../src/document/commands';
import { withSoFar } from '../../src/document/followed';
import { Store } from '../../src/document/store';
import { tellLostJobs } from '../../src/keep/lost_jobs';

/** A tab, and what it keeps while pages come and go in it. */
class Tab {
  readonly #kept = new Map<string, string>();
  getItem = (key: string) => this.#kept.get(key) ?? null;
  setItem = (key: string, value: string) => void this.#kept.set(key, value);
  removeItem = (key: string) => void this.#kept.delete(key);
}

const JOB = { id: 1, title: 'Reading', unit: '', done: 0, total: 1, startedAt: 0, cancel: () => undefined };

describe('work that was cut off by a reload', () => {
  beforeEach(() => void vi.stubGlobal('window', new EventTarget()));
  const leave = () => window.dispatchEvent(new Event('pagehide'));

  it('is told, and following is offered to be gone on with until somebody answers', () => {
    const tab = new Tab();
    const before = new Store();
    tellLostJobs(before, tab, () => undefined);
    expect(before.ui.notice).toBeNull();
    before.show({ following: true });
    leave();
    const after = new Store();
    const follow = vi.fn();
    tellLostJobs(after, tab, follow);
    expect(after.ui.notice?.text).toMatch(/came to no end: Following the film/);
    after.ui.notice?.offer?.take();
    expect(follow).toHaveBeenCalledOnce();
    const third = new Store();
    tellLostJobs(third, tab, follow);
    expect(third.ui.notice, 'once').toBeNull();
  });

  it('is told by the film itself where the page could note nothing', () => {
    const store = new Store();
    store.perform(addFrames([{ id: 'a', name: 'a', source: 'a', indexInSource: 0, width: 8, height: 8 }]));
    const pose = { x: 0, y: 0, z: -1000, zRot: 0, xRot: 0, yRot: 0 };
    store.amend((doc) => withSoFar(doc, { frameId: 'a', component: 'femur' }, pose, 'b'));
    tellLostJobs(store, new Tab(), () => undefined);
    expect(store.ui.notice?.offer?.label).toBe('Follow');
  });

  it('of another kind is told without an offer', () => {
    const tab = new Tab();
    const before = new Store();
    tellLostJobs(before, tab, () => undefined);
    before.setJob(JOB);
    leave();
    const after = new Store();
    tellLostJobs(after, tab, () => undefined);
    expect(after.ui.notice?.text).toMatch(/came to no end: Reading/);
    expect(after.ui.notice?.offer).toBeUndefined();
  });

  it.each(['{', '7', null])('is no reason to fail where the tab keeps %s, or lets nobody ask', (kept) => {
    const tab = { getItem: () => kept, setItem: () => undefined, removeItem: () => undefined };
    const store = new Store();
    tellLostJobs(store, tab, () => undefined);
    const refuse = () => {
      throw new DOMException('denied', 'SecurityError');
    };
    tellLostJobs(store, { getItem: refuse, setItem: refuse, removeItem: refuse }, () => undefined);
    tellLostJobs(store, null, () => undefined);
    store.setJob(JOB);
    leave();
    expect(store.ui.notice).toBeNull();
  });
});
