import { work } from './activity';
import type { FromWorker, Protocol, ToWorker } from './protocol/messages';
import { texts } from '../texts/texts';

/** The half of `Worker` that the bridge needs; tests supply their own. */
export interface WorkerPort {
  postMessage(message: ToWorker, transfer: Transferable[]): void;
  onmessage: ((event: MessageEvent<FromWorker>) => void) | null;
  onerror: ((event: ErrorEvent) => void) | null;
  terminate(): void;
}

/**
 * What a call is for; those that wait go in this order. A hand waits for the first, an eye for the second, the whole film for the third, and
 * nobody for the last.
 */
const LANES = ['live', 'shown', 'film', 'idle'] as const;
export type Lane = (typeof LANES)[number];

export interface CallOptions<Progress> {
  /** `shown` where nobody says. */
  readonly lane?: Lane;
  readonly signal?: AbortSignal | undefined;
  readonly transfer?: Transferable[];
  readonly onProgress?: (progress: Progress) => void;
}

interface Waiting {
  readonly method: string;
  readonly input: unknown;
  readonly options: CallOptions<never>;
  readonly resolve: (output: never) => void;
  readonly reject: (error: Error) => void;
}

/** A call was aborted: by its own signal, so nobody needs to hear of it. */
export class Aborted extends Error {
  constructor() {
    super('aborted');
  }
}

/** The worker stopped by itself while it worked on a call, or with calls waiting: nothing was found out about them. */
export class WorkerStopped extends Error {}

/**
 * Calls into a worker, one at a time: lane by lane, in each in the order asked. A call aborted in the queue never reaches the worker; one
 * that is running is told, and what it still sends is dropped.
 */
export class Bridge<P extends Protocol<P>> {
  readonly #start: () => WorkerPort;
  #port: WorkerPort | null = null;
  #queue: Waiting[] = [];
  #running: { id: number; call: Waiting } | null = null;
  #lastId = 0;

  /** Called when the worker has stopped by itself and what it held is gone. */
  onCrash: () => void = () => undefined;

  /** The worker starts with the first call. */
  constructor(start: () => WorkerPort) {
    this.#start = start;
  }

  call<K extends keyof P & string>(
    method: K,
    input: P[K]['input'],
    options: CallOptions<P[K]['progress']> = {},
  ): Promise<P[K]['output']> {
    const over = work.begin();
    const { signal } = options;
    let abort = () => undefined as void;
    const answer = new Promise<P[K]['output']>((resolve, reject) => {
      if (signal?.aborted) return reject(new Aborted());
      const waiting = { method, input, options, resolve, reject } as Waiting;
      abort = () => this.#abort(waiting);
      signal?.addEventListener('abort', abort, { once: true });
      this.#queue.push(waiting);
      this.#sendNext();
    });
    return answer.finally(() => {
      // One signal may be of all calls of a film, with what each was about.
      signal?.removeEventListener('abort', abort);
      over();
    });
  }

  dispose(): void {
    this.#port?.terminate();
    this.#port = null;
    this.#failAll(new Aborted());
  }

  #sendNext(): void {
    if (this.#running) return;
    const call = this.#queue.reduce<Waiting | null>((first, one) => (first && laneOf(first) <= laneOf(one) ? first : one), null);
    if (!call) return;
    this.#queue = this.#queue.filter((other) => other !== call);
    const id = ++this.#lastId;
    this.#running = { id, call };
    const { method, input, options } = call;
    try {
      this.#openPort().postMessage({ type: 'call', id, method, input }, options.transfer ?? []);
    } catch (error) {
      // It never reached the worker, which would never answer it.
      this.#running = null;
      call.reject(error instanceof Error ? error : new Error(String(error)));
      this.#sendNext();
    }
  }

  #openPort(): WorkerPort {
    if (this.#port) return this.#port;
    const port = this.#start();
    port.onmessage = (event) => this.#receive(event.data);
    port.onerror = (event) => this.#crashed(event.message || texts.said.notLoaded);
    this.#port = port;
    return port;
  }

  #receive(message: FromWorker): void {
    const running = this.#running;
    if (!running || message.id !== running.id) return;
    if (message.type === 'progress') {
      if (running.call.options.signal?.aborted) return;
      (running.call.options as CallOptions<unknown>).onProgress?.(message.progress);
      return;
    }
    this.#running = null;
    if (message.type === 'done') running.call.resolve(message.output as never);
    else running.call.reject(new Error(message.sentence));
    this.#sendNext();
  }

  #abort(call: Waiting): void {
    this.#queue = this.#queue.filter((other) => other !== call);
    if (this.#running?.call === call) this.#port?.postMessage({ type: 'abort', id: this.#running.id }, []);
    call.reject(new Aborted());
  }

  /** A trap in WASM leaves the worker's memory in doubt: the next call starts a new one. */
  #crashed(reason: string): void {
    this.#port?.terminate();
    this.#port = null;
    this.#failAll(new WorkerStopped(texts.said.workerStopped(reason)));
    this.onCrash();
  }

  #failAll(error: Error): void {
    const calls = [...(this.#running ? [this.#running.call] : []), ...this.#queue];
    this.#running = null;
    this.#queue = [];
    for (const call of calls) call.reject(error);
  }
}

function laneOf({ options: { lane = 'shown' } }: Waiting): number {
  return LANES.indexOf(lane);
}
