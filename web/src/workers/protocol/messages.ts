/** What passes between the page and a worker. */
export type ToWorker =
  | { readonly type: 'call'; readonly id: number; readonly method: string; readonly input: unknown }
  | { readonly type: 'abort'; readonly id: number };

export type FromWorker =
  | { readonly type: 'progress'; readonly id: number; readonly progress: unknown }
  | { readonly type: 'done'; readonly id: number; readonly output: unknown }
  | { readonly type: 'failed'; readonly id: number; readonly sentence: string };

/** A method's input, output and the progress it reports. */
export interface Method {
  readonly input: unknown;
  readonly output: unknown;
  readonly progress: unknown;
}

export type Protocol<P> = { readonly [K in keyof P]: Method };
