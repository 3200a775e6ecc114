import { buffersIn } from './buffers';
import type { FromWorker, Method, Protocol, ToWorker } from '../protocol/messages';

/** What a handler may do besides returning. */
export interface Context<Progress> {
  report(progress: Progress): void;
  /** Lets messages in; throws when the call was aborted in the meantime. Long work calls it every few milliseconds. */
  breathe(): Promise<void>;
}

type Handler<M extends Method> = (
  input: M['input'],
  context: Context<M['progress']>,
) => M['output'] | Promise<M['output']>;

export type Handlers<P extends Protocol<P>> = { readonly [K in keyof P]: Handler<P[K]> };

/** Answers the calls of a `Bridge` inside a worker. */
export function serve<P extends Protocol<P>>(handlers: Handlers<P>): void {
  const aborted = new Set<number>();
  self.onmessage = (event: MessageEvent<ToWorker>) => {
    const message = event.data;
    if (message.type === 'abort') aborted.add(message.id);
    else void answer(handlers as unknown as Record<string, Handler<Method>>, message, aborted);
  };
}

async function answer(
  handlers: Record<string, Handler<Method>>,
  call: Extract<ToWorker, { type: 'call' }>,
  aborted: Set<number>,
): Promise<void> {
  const { id, method, input } = call;
  const context: Context<unknown> = {
    report: (progress) => send({ type: 'progress', id, progress }),
    breathe: async () => {
      await nextMessage();
      if (aborted.has(id)) throw new Error('aborted');
    },
  };
  try {
    const handler = handlers[method];
    if (!handler) throw new Error(`this worker has no method "${method}"`);
    send({ type: 'done', id, output: await handler(input, context) });
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) return crash(error);
    send({ type: 'failed', id, sentence: error instanceof Error ? error.message : String(error) });
  } finally {
    aborted.delete(id);
  }
}

/** Thrown outside any promise, so that the page's `onerror` hears of it: the memory behind a trap is not to be trusted. */
function crash(error: Error): void {
  setTimeout(() => {
    throw error;
  });
}

/** What a worker answers it has made for that: buffers are handed over, not copied. */
function send(message: FromWorker): void {
  self.postMessage(message, { transfer: buffersIn(message) });
}

/** Unlike a timer, a message to oneself is not slowed down when nested. */
function nextMessage(): Promise<void> {
  return new Promise((resolve) => {
    const channel = new MessageChannel();
    channel.port1.onmessage = () => {
      channel.port1.close();
      resolve();
    };
    channel.port2.postMessage(null);
  });
}
