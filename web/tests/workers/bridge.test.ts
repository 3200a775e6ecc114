import { describe, expect, it, vi } from 'vitest';
import { Aborted, Bridge, type WorkerPort } from '../../src/workers/bridge';
import type { FromWorker, ToWorker } from '../../src/workers/protocol/messages';

interface Echo {
  echo: { input: number; output: number; progress: number };
}

/** A worker that answers when the test says so. */
class FakePort implements WorkerPort {
  readonly sent: ToWorker[] = [];
  onmessage: ((event: MessageEvent<FromWorker>) => void) | null = null;
  onerror: ((event: ErrorEvent) => void) | null = null;
  terminated = false;

  postMessage(message: ToWorker): void {
    this.sent.push(message);
  }

  terminate(): void {
    this.terminated = true;
  }

  answer(message: FromWorker): void {
    this.onmessage?.({ data: message } as MessageEvent<FromWorker>);
  }
}

function bench() {
  const ports: FakePort[] = [];
  const bridge = new Bridge<Echo>(() => {
    const port = new FakePort();
    ports.push(port);
    return port;
  });
  return { bridge, ports };
}

describe('bridge', () => {
  it('sends one call at a time, in order', async () => {
    const { bridge, ports } = bench();
    const first = bridge.call('echo', 1);
    const second = bridge.call('echo', 2);
    expect(ports[0]?.sent).toEqual([{ type: 'call', id: 1, method: 'echo', input: 1 }]);
    ports[0]?.answer({ type: 'done', id: 1, output: 10 });
    expect(await first).toBe(10);
    ports[0]?.answer({ type: 'done', id: 2, output: 20 });
    expect(await second).toBe(20);
  });

  it('lets those before whom a hand or an eye waits go first, and others in the order asked', async () => {
    const { bridge, ports } = bench();
    const lanes = ['film', 'idle', 'film', 'shown', undefined, 'live'] as const;
    const calls = lanes.map((lane, at) => bridge.call('echo', at, lane ? { lane } : {}));
    for (let id = 1; id <= lanes.length; id++) {
      ports[0]?.answer({ type: 'done', id, output: id });
      await Promise.resolve();
    }
    await Promise.all(calls);
    // The first was under way before the others came.
    expect(ports[0]?.sent.map((message) => message.type === 'call' && message.input)).toEqual([0, 5, 3, 4, 2, 1]);
  });

  it('leaves nothing on the signal of a call that is over', async () => {
    const { bridge, ports } = bench();
    const { signal } = new AbortController();
    const [added, removed] = [vi.spyOn(signal, 'addEventListener'), vi.spyOn(signal, 'removeEventListener')];
    const call = bridge.call('echo', 1, { signal });
    ports[0]?.answer({ type: 'done', id: 1, output: 10 });
    await call;
    expect(removed.mock.calls.map(([type, abort]) => [type, abort])).toEqual(added.mock.calls.map(([type, abort]) => [type, abort]));
    expect(added).toHaveBeenCalledOnce();
  });

  it('goes on after a call that could not be posted', async () => {
    const { bridge, ports } = bench();
    const first = bridge.call('echo', 1);
    const refusing = ports[0]!;
    const postMessage = vi.spyOn(refusing, 'postMessage').mockImplementationOnce(() => {
      throw new Error('it cannot be cloned');
    });
    refusing.answer({ type: 'done', id: 1, output: 10 });
    await first;
    const second = bridge.call('echo', 2);
    const third = bridge.call('echo', 3);
    await expect(second).rejects.toThrow('it cannot be cloned');
    expect(postMessage).toHaveBeenCalledTimes(2);
    refusing.answer({ type: 'done', id: 3, output: 30 });
    expect(await third).toBe(30);
  });

  it('drops the late progress of a call that was aborted', async () => {
    const { bridge, ports } = bench();
    const abort = new AbortController();
    const onProgress = vi.fn();
    const call = bridge.call('echo', 1, { signal: abort.signal, onProgress });
    ports[0]?.answer({ type: 'progress', id: 1, progress: 1 as never });
    abort.abort();
    await expect(call).rejects.toThrow(Aborted);
    ports[0]?.answer({ type: 'progress', id: 1, progress: 2 as never });
    expect(onProgress).toHaveBeenCalledTimes(1);
  });

  it('never sends a call that was aborted in the queue', async () => {
    const { bridge, ports } = bench();
    const first = bridge.call('echo', 1);
    const abort = new AbortController();
    const second = bridge.call('echo', 2, { signal: abort.signal });
    abort.abort();
    await expect(second).rejects.toThrow(Aborted);
    ports[0]?.answer({ type: 'done', id: 1, output: 1 });
    await first;
    expect(ports[0]?.sent.length).toBe(1);
  });

  it('tells the worker of an abort, drops its answer and goes on afterwards', async () => {
    const { bridge, ports } = bench();
    const abort = new AbortController();
    const first = bridge.call('echo', 1, { signal: abort.signal });
    const second = bridge.call('echo', 2);
    abort.abort();
    await expect(first).rejects.toThrow(Aborted);
    expect(ports[0]?.sent.at(-1)).toEqual({ type: 'abort', id: 1 });
    ports[0]?.answer({ type: 'failed', id: 1, sentence: 'aborted' });
    ports[0]?.answer({ type: 'done', id: 2, output: 2 });
    expect(await second).toBe(2);
  });

  it('takes no answer for another call', async () => {
    const { bridge, ports } = bench();
    const first = bridge.call('echo', 1);
    ports[0]?.answer({ type: 'done', id: 99, output: 99 });
    ports[0]?.answer({ type: 'done', id: 1, output: 1 });
    expect(await first).toBe(1);
  });

  it('passes on progress and failures', async () => {
    const { bridge, ports } = bench();
    const onProgress = vi.fn();
    const call = bridge.call('echo', 1, { onProgress });
    ports[0]?.answer({ type: 'progress', id: 1, progress: 5 });
    ports[0]?.answer({ type: 'failed', id: 1, sentence: 'The file is cut short' });
    await expect(call).rejects.toThrow('The file is cut short');
    expect(onProgress).toHaveBeenCalledWith(5);
  });

  it('starts a new worker after a crash and says that the old one is gone', async () => {
    const { bridge, ports } = bench();
    bridge.onCrash = vi.fn();
    const call = bridge.call('echo', 1);
    ports[0]?.onerror?.({ message: 'unreachable' } as ErrorEvent);
    await expect(call).rejects.toThrow(/unreachable/);
    expect(ports[0]?.terminated).toBe(true);
    expect(bridge.onCrash).toHaveBeenCalledOnce();
    void bridge.call('echo', 2).catch(() => undefined);
    expect(ports.length).toBe(2);
    bridge.dispose();
  });
});
