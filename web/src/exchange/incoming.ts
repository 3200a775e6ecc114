import type { ComponentName } from '../terms/component';

/** A file as it came, from a button, a drop or an address. */
export interface Incoming {
  readonly name: string;
  readonly bytes: Uint8Array<ArrayBuffer>;
  /** With its folders, where the browser tells. */
  readonly path?: string;
  /** Where the person said what it is for. */
  readonly component?: ComponentName | undefined;
}
